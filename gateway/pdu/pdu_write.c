/* The writer of PDUs, by the table of layouts. */
#include "gateway/pdu/pdu_write.h"

#include "gateway/pdu/octets.h"
#include "gateway/pdu/pdu_layout.h"

static void put_entity_type(uint8_t *at, struct pdu_entity_type type)
{
    at[0] = type.kind;
    at[1] = type.domain;
    octets_put_u16(at + 2, type.country);
    at[4] = type.category;
    at[5] = type.subcategory;
    at[6] = type.specific;
    at[7] = type.extra;
}

static void put_field(const struct pdu_field *field, const void *from, uint8_t *at)
{
    float f32[6];
    double f64[6];
    uint16_t u16;
    uint32_t u32;
    struct pdu_id id;
    struct pdu_clock clock;
    struct pdu_entity_type type;
    switch ((enum pdu_field_kind)field->kind) {
    case PDU_FIELD_U8:
        memcpy(at, from, 1);
        break;
    case PDU_FIELD_U16:
        memcpy(&u16, from, sizeof u16);
        octets_put_u16(at, u16);
        break;
    case PDU_FIELD_U32:
        memcpy(&u32, from, sizeof u32);
        octets_put_u32(at, u32);
        break;
    case PDU_FIELD_F32:
        memcpy(f32, from, field->count * sizeof f32[0]);
        for (unsigned i = 0; i < field->count; i++)
            octets_put_f32(at + 4 * i, f32[i]);
        break;
    case PDU_FIELD_F64:
        memcpy(f64, from, field->count * sizeof f64[0]);
        for (unsigned i = 0; i < field->count; i++)
            octets_put_f64(at + 8 * i, f64[i]);
        break;
    case PDU_FIELD_ID:
        memcpy(&id, from, sizeof id);
        octets_put_u16(at, id.site);
        octets_put_u16(at + 2, id.application);
        octets_put_u16(at + 4, id.entity);
        break;
    case PDU_FIELD_ENTITY_TYPE:
        memcpy(&type, from, sizeof type);
        put_entity_type(at, type);
        break;
    case PDU_FIELD_CLOCK:
        memcpy(&clock, from, sizeof clock);
        octets_put_u32(at, (uint32_t)clock.hours);
        octets_put_u32(at + 4, clock.past_hour);
        break;
    case PDU_FIELD_MARKING:
        memcpy(at, from, PDU_MARKING_MAX);
        break;
    }
}

static void put_part(const struct pdu_part *part, uint8_t *at)
{
    at[0] = part->kind;
    at[1] = part->change;
    octets_put_u16(at + 2, part->attached_to);
    octets_put_u32(at + 4, part->type);
    if (part->kind == PDU_PART_ARTICULATED)
        octets_put_f32(at + 8, part->value);
    else
        put_entity_type(at + 8, part->carried);
}

size_t pdu_write(const struct pdu *pdu, uint8_t *bytes, size_t size)
{
    const struct pdu_layout *layout = pdu_layout_of(pdu->header.type);
    if (!layout || pdu->header.version < 6 || pdu->header.version > PDU_VERSION_MOST)
        return 0;
    uint8_t parts = layout->parts_at > 0 ? pdu->parts : 0;
    size_t length = layout->bytes + (size_t)PDU_PART_BYTES * parts;
    if (length > size)
        return 0;
    memset(bytes, 0, length);
    bytes[0] = pdu->header.version;
    bytes[1] = pdu->header.exercise;
    bytes[2] = pdu->header.type;
    bytes[3] = layout->family;
    octets_put_u32(bytes + 4, pdu->header.timestamp);
    octets_put_u16(bytes + 8, (uint16_t)length);
    bytes[10] = pdu->header.version == 7 ? pdu->header.status : 0;
    for (unsigned i = 0; i < layout->field_count; i++) {
        const struct pdu_field *field = &layout->fields[i];
        put_field(field, (const char *)pdu + field->member, bytes + field->at);
    }
    if (layout->parts_at > 0)
        bytes[layout->parts_at] = parts;
    for (unsigned i = 0; i < parts; i++)
        put_part(&pdu->part[i], bytes + layout->bytes + PDU_PART_BYTES * i);
    return length;
}
