/* Words of fields. */
#include "gateway/tool/field_words.h"

#include "gateway/earth/local_frame.h"
#include "gateway/pdu/pdu_layout.h"
#include "world/runtime/parse_number.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define NUMBERS_MAX 7u
#define VALUE_MAX   256u

/* How the value of each kind of field is written, for one number and for more. */
static const char *form_of(const struct pdu_field *field)
{
    static const char *const forms[] = {
        [PDU_FIELD_U8] = "0..255",
        [PDU_FIELD_U16] = "0..65535",
        [PDU_FIELD_U32] = "0..4294967295, or hexadecimal with 0x",
        [PDU_FIELD_ID] = "SITE:APPLICATION:ENTITY",
        [PDU_FIELD_ENTITY_TYPE] = "KIND.DOMAIN.COUNTRY.CATEGORY.SUBCATEGORY.SPECIFIC.EXTRA",
        [PDU_FIELD_CLOCK] = "HOURS:UNITS",
        [PDU_FIELD_MARKING] = "at most 11 printable characters of ASCII",
    };
    if (field->kind == PDU_FIELD_F32 || field->kind == PDU_FIELD_F64)
        return field->count == 1 ? "NUMBER" : field->count == 3 ? "X,Y,Z" : "XX,XY,XZ,YY,YZ,ZZ";
    return forms[field->kind];
}

/* Splits a value at a mark into count parts. Returns false if there are more or fewer. */
static bool split(char *value, char mark, unsigned count, char *part[])
{
    for (unsigned i = 0; i < count; i++) {
        part[i] = value;
        char *next = strchr(value, mark);
        if ((next == NULL) != (i == count - 1))
            return false;
        if (next) {
            *next = '\0';
            value = next + 1;
        }
    }
    return true;
}

static bool whole(const char *text, uint64_t most, uint64_t *number)
{
    if (text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) {
        char *end;
        if (strspn(text + 2, "0123456789abcdefABCDEF") == 0 || strlen(text) > 18)
            return false;
        *number = strtoull(text + 2, &end, 16);
        return *end == '\0' && *number <= most;
    }
    return parse_whole(text, 0, most, number);
}

static bool wholes(char *value, char mark, unsigned count, uint64_t most, uint64_t *number)
{
    char *part[NUMBERS_MAX];
    if (!split(value, mark, count, part))
        return false;
    for (unsigned i = 0; i < count; i++) {
        if (!whole(part[i], most, &number[i]))
            return false;
    }
    return true;
}

static bool reals(char *value, unsigned count, double limit, double *number)
{
    char *part[NUMBERS_MAX];
    if (!split(value, ',', count, part))
        return false;
    for (unsigned i = 0; i < count; i++) {
        if (!parse_real(part[i], -limit, limit, &number[i]))
            return false;
    }
    return true;
}

static bool set_marking(const char *value, char *marking)
{
    size_t length = strlen(value);
    if (length > PDU_MARKING_MAX)
        return false;
    for (size_t i = 0; i < length; i++) {
        if (value[i] < ' ' || value[i] > '~')
            return false;
    }
    memset(marking, 0, PDU_MARKING_MAX + 1);
    (void)snprintf(marking, PDU_MARKING_MAX + 1, "%s", value);
    return true;
}

static bool set_entity_type(char *value, void *to)
{
    uint64_t n[NUMBERS_MAX];
    if (!wholes(value, '.', 7, UINT16_MAX, n))
        return false;
    for (unsigned i = 0; i < 7; i++) {
        if (i != 2 && n[i] > UINT8_MAX)
            return false;
    }
    struct pdu_entity_type type = {(uint8_t)n[0], (uint8_t)n[1], (uint16_t)n[2], (uint8_t)n[3],
                                   (uint8_t)n[4], (uint8_t)n[5], (uint8_t)n[6]};
    memcpy(to, &type, sizeof type);
    return true;
}

static bool set_reals(const struct pdu_field *field, char *value, void *to)
{
    double number[NUMBERS_MAX];
    bool f32 = field->kind == PDU_FIELD_F32;
    if (!reals(value, field->count, f32 ? 1e30 : 1e15, number))
        return false;
    for (unsigned i = 0; i < field->count; i++) {
        if (f32)
            memcpy((char *)to + 4 * i, &(float){(float)number[i]}, 4);
        else
            memcpy((char *)to + 8 * i, &number[i], 8);
    }
    return true;
}

static bool set_value(const struct pdu_field *field, char *value, void *to)
{
    uint64_t n[NUMBERS_MAX];
    switch ((enum pdu_field_kind)field->kind) {
    case PDU_FIELD_U8:
        return whole(value, UINT8_MAX, n) && memcpy(to, &(uint8_t){(uint8_t)n[0]}, 1);
    case PDU_FIELD_U16:
        return whole(value, UINT16_MAX, n) && memcpy(to, &(uint16_t){(uint16_t)n[0]}, 2);
    case PDU_FIELD_U32:
        return whole(value, UINT32_MAX, n) && memcpy(to, &(uint32_t){(uint32_t)n[0]}, 4);
    case PDU_FIELD_F32:
    case PDU_FIELD_F64:
        return set_reals(field, value, to);
    case PDU_FIELD_ID:
        return wholes(value, ':', 3, UINT16_MAX, n) &&
               memcpy(to, &(struct pdu_id){(uint16_t)n[0], (uint16_t)n[1], (uint16_t)n[2]},
                      sizeof(struct pdu_id));
    case PDU_FIELD_ENTITY_TYPE:
        return set_entity_type(value, to);
    case PDU_FIELD_CLOCK:
        return wholes(value, ':', 2, UINT32_MAX, n) && n[0] <= INT32_MAX &&
               memcpy(to, &(struct pdu_clock){(int32_t)n[0], (uint32_t)n[1]},
                      sizeof(struct pdu_clock));
    case PDU_FIELD_MARKING:
        return set_marking(value, to);
    }
    return false;
}

/* Adds or sets an articulated part. */
static bool set_part(struct pdu *pdu, const char *value, uint32_t type, uint16_t attached_to)
{
    double degrees;
    if (!parse_real(value, -360.0, 360.0, &degrees))
        return false;
    unsigned i = 0;
    while (i < pdu->parts && pdu->part[i].type != type)
        i++;
    if (i == pdu->parts)
        pdu->parts++; /* two types at most */
    pdu->part[i] = (struct pdu_part){.kind = PDU_PART_ARTICULATED,
                                     .attached_to = attached_to,
                                     .type = type,
                                     .value = (float)(degrees * RAD_PER_DEG)};
    return true;
}

static bool set_place(double *location, char *value)
{
    double number[3];
    if (!reals(value, 3, 1e7, number) || fabs(number[0]) > 90.0 || fabs(number[1]) > 180.0)
        return false;
    struct vec3 ecef = geodesy_ecef(
        (struct geodesy_place){number[0] * RAD_PER_DEG, number[1] * RAD_PER_DEG, number[2]});
    memcpy(location, (double[3]){ecef.x, ecef.y, ecef.z}, 3 * sizeof *location);
    return true;
}

static bool set_attitude(struct pdu_entity_state *entity, char *value)
{
    double number[3];
    struct local_frame frame;
    if (!reals(value, 3, 360.0, number) || entity->location[0] == 0.0)
        return false;
    struct geodesy_place place = geodesy_place_of(
        (struct vec3){entity->location[0], entity->location[1], entity->location[2]});
    local_frame_make(&frame, place.latitude_rad * DEG_PER_RAD, place.longitude_rad * DEG_PER_RAD,
                     0.0, 0.0, 0.0);
    struct mat3 turn = rotation_matrix(
        rotation_of(number[0] * RAD_PER_DEG, number[1] * RAD_PER_DEG, number[2] * RAD_PER_DEG));
    struct mat3 matrix = local_frame_ecef_turn(&frame.axes, &turn);
    struct euler angles = euler_of(&matrix);
    vec3_to_floats(entity->orientation, (struct vec3){angles.psi, angles.theta, angles.phi});
    return true;
}

#define FORM_PLACE    "LATITUDE,LONGITUDE,HEIGHT in degrees and metres above the ellipsoid"
#define FORM_ATTITUDE "HEADING,PITCH,ROLL in degrees, after place or location"
#define FORM_PART     "DEGREES"

/* Sets what is no field of the wire. Returns the form of a value that is wrong, "" when it is good,
 * NULL when the name is another one. */
static const char *set_special(struct pdu *pdu, const struct pdu_layout *layout, const char *name,
                               char *value)
{
    const struct pdu_field *location = pdu_layout_field(layout, "location");
    bool state = layout->type == PDU_ENTITY_STATE;
    if (location && strcmp(name, "place") == 0)
        return set_place((double *)(void *)((char *)pdu + location->member), value) ? ""
                                                                                    : FORM_PLACE;
    if (state && strcmp(name, "attitude") == 0)
        return set_attitude(&pdu->entity_state, value) ? "" : FORM_ATTITUDE;
    if (state && strcmp(name, "turret") == 0)
        return set_part(pdu, value, PDU_TURRET_AZIMUTH, 0) ? "" : FORM_PART;
    if (state && strcmp(name, "gun") == 0)
        return set_part(pdu, value, PDU_GUN_ELEVATION, 1) ? "" : FORM_PART;
    return NULL;
}

int field_words_set(struct pdu *pdu, const char *word, struct error_text *error)
{
    const struct pdu_layout *layout = pdu_layout_of(pdu->header.type);
    const char *equals = strchr(word, '=');
    char name[32], value[VALUE_MAX];
    if (!equals || equals == word || (size_t)(equals - word) >= sizeof name ||
        strlen(equals + 1) >= sizeof value)
        return error_text_set(
            error, "%.60s: must be FIELD=VALUE; jolon dis send --fields %s lists the fields", word,
            layout->name);
    memcpy(name, word, (size_t)(equals - word));
    name[equals - word] = '\0';
    (void)snprintf(value, sizeof value, "%s", equals + 1);
    const struct pdu_field *field = pdu_layout_field(layout, name);
    const char *form;
    if (field)
        form = set_value(field, value, (char *)pdu + field->member) ? "" : form_of(field);
    else
        form = set_special(pdu, layout, name, value);
    if (!form)
        return error_text_set(error,
                              "%s: no such field; jolon dis send --fields %s lists the fields",
                              name, layout->name);
    if (form[0] != '\0')
        return error_text_set(error, "%s=%s: must be %s", name, equals + 1, form);
    return 0;
}

void field_words_list(FILE *file, uint8_t type)
{
    const struct pdu_layout *layout = pdu_layout_of(type);
    for (unsigned i = 0; i < layout->field_count; i++)
        fprintf(file, "%s=%s\n", layout->fields[i].name, form_of(&layout->fields[i]));
    if (pdu_layout_field(layout, "location"))
        fprintf(file, "place=%s\n", FORM_PLACE);
    if (type == PDU_ENTITY_STATE)
        fprintf(file, "attitude=%s\nturret=%s\ngun=%s\n", FORM_ATTITUDE, FORM_PART, FORM_PART);
}
