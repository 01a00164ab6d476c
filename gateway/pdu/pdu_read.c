/* The reader of PDUs: the header, then the fields by the table of layouts, then the variable
 * parameters. */
#include "gateway/pdu/pdu_read.h"

#include "gateway/pdu/octets.h"
#include "gateway/pdu/pdu_layout.h"

#include <math.h>
#include <stdbool.h>

#define LARGEST 1e30 /* no field of a simulation is larger */
#define BODY_AT offsetof(struct pdu, entity_state)

const char *pdu_result_text(enum pdu_result result)
{
    static const char *const text[PDU_RESULTS] = {
        [PDU_GOOD] = "good",
        [PDU_END] = "the end of the datagram",
        [PDU_SKIPPED] = "a type that Jolon does not know",
        [PDU_BAD_HEADER] = "fewer than 12 octets for a header",
        [PDU_BAD_LENGTH] = "a length below 12 or beyond the datagram",
        [PDU_BAD_VERSION] = "a version other than 5, 6 and 7",
        [PDU_BAD_FAMILY] = "a family that is not that of the type",
        [PDU_TOO_SHORT] = "a length without room for all fields",
        [PDU_NOT_FINITE] = "a number that is not finite",
        [PDU_BAD_ID] = "an entity with a reserved number",
    };
    return result < PDU_RESULTS ? text[result] : "?";
}

static struct pdu_entity_type entity_type_of(const uint8_t *at)
{
    return (struct pdu_entity_type){at[0], at[1], octets_u16(at + 2), at[4], at[5], at[6], at[7]};
}

/* Copies 11 characters up to a NUL. Characters that are no printable ASCII become '?'. */
static void read_marking(const uint8_t *at, char marking[PDU_MARKING_MAX + 1])
{
    memset(marking, 0, PDU_MARKING_MAX + 1);
    for (unsigned i = 0; i < PDU_MARKING_MAX && at[i] != '\0'; i++)
        marking[i] = at[i] >= ' ' && at[i] < 0x7f ? (char)at[i] : '?';
}

static bool usable(double value)
{
    return fabs(value) <= LARGEST; /* false for what is not a number */
}

/* Reads the numbers of a field. Returns false if one is not usable. */
static bool read_field(const struct pdu_field *field, const uint8_t *at, void *to)
{
    float f32[6];
    double f64[6];
    struct pdu_id id;
    struct pdu_clock clock;
    struct pdu_entity_type type;
    bool good = true;
    switch ((enum pdu_field_kind)field->kind) {
    case PDU_FIELD_U8:
        memcpy(to, at, 1);
        break;
    case PDU_FIELD_U16:
        memcpy(to, &(uint16_t){octets_u16(at)}, 2);
        break;
    case PDU_FIELD_U32:
        memcpy(to, &(uint32_t){octets_u32(at)}, 4);
        break;
    case PDU_FIELD_F32:
        for (unsigned i = 0; i < field->count; i++) {
            f32[i] = octets_f32(at + 4 * i);
            good &= usable((double)f32[i]);
        }
        memcpy(to, f32, field->count * sizeof f32[0]);
        break;
    case PDU_FIELD_F64:
        for (unsigned i = 0; i < field->count; i++) {
            f64[i] = octets_f64(at + 8 * i);
            good &= usable(f64[i]);
        }
        memcpy(to, f64, field->count * sizeof f64[0]);
        break;
    case PDU_FIELD_ID:
        id = (struct pdu_id){octets_u16(at), octets_u16(at + 2), octets_u16(at + 4)};
        memcpy(to, &id, sizeof id);
        break;
    case PDU_FIELD_ENTITY_TYPE:
        type = entity_type_of(at);
        memcpy(to, &type, sizeof type);
        break;
    case PDU_FIELD_CLOCK:
        clock = (struct pdu_clock){(int32_t)octets_u32(at), octets_u32(at + 4)};
        memcpy(to, &clock, sizeof clock);
        break;
    case PDU_FIELD_MARKING:
        read_marking(at, to);
        break;
    }
    return good;
}

/* Reads the variable parameters. Returns false if a number is not usable. */
static bool read_parts(const uint8_t *at, uint8_t count, struct pdu *pdu)
{
    for (unsigned i = 0; i < count; i++, at += PDU_PART_BYTES) {
        struct pdu_part part = {.kind = at[0],
                                .change = at[1],
                                .attached_to = octets_u16(at + 2),
                                .type = octets_u32(at + 4)};
        if (part.kind == PDU_PART_ARTICULATED) {
            part.value = octets_f32(at + 8);
            if (!usable((double)part.value))
                return false;
        } else if (part.kind == PDU_PART_ATTACHED) {
            part.carried = entity_type_of(at + 8);
        } else {
            pdu->parts_skipped++;
            continue;
        }
        pdu->part[pdu->parts++] = part;
    }
    return true;
}

/* Returns true for numbers that mean no entity, or several: 0 none, FFFF all, and FFFE one that is
 * to be given a number. */
static bool reserved(struct pdu_id id)
{
    return id.site == 0 || id.site == PDU_ID_ALL || id.application == 0 ||
           id.application == PDU_ID_ALL || id.entity == 0 || id.entity >= 0xfffe;
}

/* Reads the body of a PDU whose header is set. */
static enum pdu_result read_body(const uint8_t *bytes, struct pdu *pdu)
{
    const struct pdu_layout *layout = pdu_layout_of(pdu->header.type);
    if (pdu->header.version < PDU_VERSION_LEAST || pdu->header.version > PDU_VERSION_MOST)
        return PDU_BAD_VERSION;
    if (!layout)
        return PDU_SKIPPED;
    if (pdu->header.family != layout->family)
        return PDU_BAD_FAMILY;
    if (pdu->header.length < layout->bytes)
        return PDU_TOO_SHORT;
    uint8_t parts = layout->parts_at > 0 ? bytes[layout->parts_at] : 0;
    if (pdu->header.length < layout->bytes + PDU_PART_BYTES * parts)
        return PDU_TOO_SHORT;
    memset((char *)pdu + BODY_AT, 0, offsetof(struct pdu, part) - BODY_AT);
    bool good = true;
    for (unsigned i = 0; i < layout->field_count; i++) {
        const struct pdu_field *field = &layout->fields[i];
        good &= read_field(field, bytes + field->at, (char *)pdu + field->member);
    }
    good &= read_parts(bytes + layout->bytes, parts, pdu);
    if (!good)
        return PDU_NOT_FINITE;
    if (pdu->header.type == PDU_ENTITY_STATE && reserved(pdu->entity_state.id))
        return PDU_BAD_ID;
    return PDU_GOOD;
}

enum pdu_result pdu_read(struct pdu_cursor *cursor, struct pdu *pdu)
{
    if (cursor->at >= cursor->size && cursor->at > 0)
        return PDU_END;
    size_t left = cursor->size - cursor->at;
    bool first = cursor->at == 0;
    if (left < PDU_HEADER_BYTES) {
        cursor->at = cursor->size > 0 ? cursor->size : 1;
        return PDU_BAD_HEADER;
    }
    const uint8_t *bytes = cursor->bytes + cursor->at;
    pdu->header = (struct pdu_header){.version = bytes[0],
                                      .exercise = bytes[1],
                                      .type = bytes[2],
                                      .family = bytes[3],
                                      .timestamp = octets_u32(bytes + 4),
                                      .length = octets_u16(bytes + 8),
                                      .status = bytes[0] == 7 ? bytes[10] : 0};
    if (pdu->header.length < PDU_HEADER_BYTES || pdu->header.length > left) {
        cursor->at = cursor->size;
        return pdu->header.length == 0 && !first ? PDU_END : PDU_BAD_LENGTH;
    }
    cursor->at += pdu->header.length;
    return read_body(bytes, pdu);
}

void pdu_read_count(struct pdu_counts *counts, enum pdu_result result, const struct pdu *pdu)
{
    counts->result[result]++;
    if (result != PDU_END && result != PDU_BAD_HEADER && result != PDU_BAD_LENGTH &&
        result != PDU_BAD_VERSION)
        counts->type[pdu->header.type]++;
}
