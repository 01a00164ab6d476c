/* Text and JSON of PDUs, by the table of layouts. */
#include "gateway/pdu/pdu_text.h"

#include "gateway/pdu/pdu_layout.h"
#include "gateway/pdu/timestamp.h"

#include <inttypes.h>
#include <string.h>

const char *pdu_type_name(uint8_t type)
{
    static char other[16];
    const struct pdu_layout *layout = pdu_layout_of(type);
    if (layout)
        return layout->name;
    snprintf(other, sizeof other, "type %u", type);
    return other;
}

const char *pdu_force_name(uint8_t force)
{
    static const char *const names[] = {"other", "friendly", "opposing", "neutral"};
    return force < sizeof names / sizeof names[0] ? names[force] : "?";
}

/* The marks between the parts of a value differ: 1:2:3 as text, [1,2,3] as JSON. */
struct marks {
    const char *open, *between, *close;
};
static const struct marks json_marks = {"[", ",", "]"};

static void write_numbers(FILE *file, const uint32_t *number, unsigned count, struct marks marks)
{
    fputs(marks.open, file);
    for (unsigned i = 0; i < count; i++)
        fprintf(file, "%s%" PRIu32, i > 0 ? marks.between : "", number[i]);
    fputs(marks.close, file);
}

static void write_entity_type(FILE *file, const void *from, struct marks marks)
{
    struct pdu_entity_type type;
    memcpy(&type, from, sizeof type);
    const uint32_t number[] = {type.kind,        type.domain,   type.country, type.category,
                               type.subcategory, type.specific, type.extra};
    write_numbers(file, number, 7, marks);
}

static void write_marking(FILE *file, const char *marking)
{
    fputc('"', file);
    for (; *marking != '\0'; marking++) { /* printable ASCII alone */
        if (*marking == '"' || *marking == '\\')
            fputc('\\', file);
        fputc(*marking, file);
    }
    fputc('"', file);
}

static void write_floats(FILE *file, const struct pdu_field *field, const void *from,
                         struct marks marks)
{
    bool single = field->count == 1;
    fputs(single ? "" : marks.open, file);
    for (unsigned i = 0; i < field->count; i++) {
        fputs(i > 0 ? marks.between : "", file);
        float f32;
        double f64;
        if (field->kind == PDU_FIELD_F32) {
            memcpy(&f32, (const char *)from + i * sizeof f32, sizeof f32);
            fprintf(file, "%.9g", (double)f32);
        } else {
            memcpy(&f64, (const char *)from + i * sizeof f64, sizeof f64);
            fprintf(file, "%.17g", f64);
        }
    }
    fputs(single ? "" : marks.close, file);
}

static void write_value(FILE *file, const struct pdu_field *field, const void *from, bool json)
{
    struct marks marks = json ? json_marks : (struct marks){"", ",", ""};
    uint8_t u8;
    uint16_t u16;
    uint32_t u32;
    struct pdu_id id;
    struct pdu_clock clock;
    switch ((enum pdu_field_kind)field->kind) {
    case PDU_FIELD_U8:
        memcpy(&u8, from, sizeof u8);
        fprintf(file, "%u", u8);
        break;
    case PDU_FIELD_U16:
        memcpy(&u16, from, sizeof u16);
        fprintf(file, "%u", u16);
        break;
    case PDU_FIELD_U32:
        memcpy(&u32, from, sizeof u32);
        fprintf(file, "%" PRIu32, u32);
        break;
    case PDU_FIELD_F32:
    case PDU_FIELD_F64:
        write_floats(file, field, from, marks);
        break;
    case PDU_FIELD_ID:
        memcpy(&id, from, sizeof id);
        marks.between = json ? "," : ":";
        write_numbers(file, (const uint32_t[]){id.site, id.application, id.entity}, 3, marks);
        break;
    case PDU_FIELD_ENTITY_TYPE:
        marks.between = json ? "," : ".";
        write_entity_type(file, from, marks);
        break;
    case PDU_FIELD_CLOCK:
        memcpy(&clock, from, sizeof clock);
        fprintf(file, json ? "[%" PRId32 ",%" PRIu32 "]" : "%" PRId32 ":%" PRIu32, clock.hours,
                clock.past_hour);
        break;
    case PDU_FIELD_MARKING:
        write_marking(file, from);
        break;
    }
}

void pdu_text_write_header(FILE *file, const struct pdu_header *header)
{
    fprintf(file, "%s version=%u exercise=%u timestamp=%.6f%s length=%u",
            pdu_type_name(header->type), header->version, header->exercise,
            timestamp_seconds(header->timestamp), timestamp_absolute(header->timestamp) ? "" : "r",
            header->length);
    if (header->version == 7)
        fprintf(file, " status=%u", header->status);
}

void pdu_json_write_header(FILE *file, const struct pdu_header *header)
{
    if (pdu_layout_of(header->type))
        fprintf(file, "\"pdu\":\"%s\"", pdu_type_name(header->type));
    else
        fprintf(file, "\"pdu\":%u", header->type);
    fprintf(file,
            ",\"version\":%u,\"exercise\":%u,\"family\":%u,\"timestamp\":%" PRIu32
            ",\"past_hour_s\":%.9f,\"absolute\":%s,\"length\":%u,\"status\":%u",
            header->version, header->exercise, header->family, header->timestamp,
            timestamp_seconds(header->timestamp),
            timestamp_absolute(header->timestamp) ? "true" : "false", header->length,
            header->status);
}

void pdu_text_write(FILE *file, const struct pdu *pdu)
{
    const struct pdu_layout *layout = pdu_layout_of(pdu->header.type);
    pdu_text_write_header(file, &pdu->header);
    for (unsigned i = 0; layout && i < layout->field_count; i++) {
        const struct pdu_field *field = &layout->fields[i];
        fprintf(file, " %s=", field->name);
        write_value(file, field, (const char *)pdu + field->member, false);
    }
    for (unsigned i = 0; i < pdu->parts; i++) {
        const struct pdu_part *part = &pdu->part[i];
        if (part->kind == PDU_PART_ARTICULATED) {
            fprintf(file, " articulated=%u:%" PRIu32 ":%.9g", part->attached_to, part->type,
                    (double)part->value);
        } else {
            fprintf(file, " attached=%u:%" PRIu32 ":", part->attached_to, part->type);
            write_entity_type(file, &part->carried, (struct marks){"", ".", ""});
        }
    }
}

static void write_json_parts(FILE *file, const struct pdu *pdu)
{
    fputs(",\"parts\":[", file);
    for (unsigned i = 0; i < pdu->parts; i++) {
        const struct pdu_part *part = &pdu->part[i];
        bool articulated = part->kind == PDU_PART_ARTICULATED;
        fprintf(file, "%s{\"kind\":\"%s\",\"change\":%u,\"attached_to\":%u,\"%s\":%" PRIu32 ",",
                i > 0 ? "," : "", articulated ? "articulated" : "attached", part->change,
                part->attached_to, articulated ? "type" : "station", part->type);
        if (articulated) {
            fprintf(file, "\"value\":%.9g}", (double)part->value);
            continue;
        }
        fputs("\"type\":", file);
        write_entity_type(file, &part->carried, json_marks);
        fputc('}', file);
    }
    fprintf(file, "],\"parts_skipped\":%u", pdu->parts_skipped);
}

void pdu_json_write(FILE *file, const struct pdu *pdu)
{
    const struct pdu_layout *layout = pdu_layout_of(pdu->header.type);
    pdu_json_write_header(file, &pdu->header);
    for (unsigned i = 0; layout && i < layout->field_count; i++) {
        const struct pdu_field *field = &layout->fields[i];
        fprintf(file, ",\"%s\":", field->name);
        write_value(file, field, (const char *)pdu + field->member, true);
    }
    if (layout && layout->parts_at > 0)
        write_json_parts(file, pdu);
}
