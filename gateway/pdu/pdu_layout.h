/* The layouts of PDUs on the wire: one table from which a PDU is read, written, printed and built
 * from words. A new type is a row here and its structure in pdu.h. Source: IEEE 1278.1-2012 clause
 * 7, whose layouts of these types hold for versions 5 to 7. Pure. */
#ifndef JOLON_GATEWAY_PDU_PDU_LAYOUT_H
#define JOLON_GATEWAY_PDU_PDU_LAYOUT_H

#include "gateway/pdu/pdu.h"

#include <stdbool.h>

enum pdu_field_kind {
    PDU_FIELD_U8,
    PDU_FIELD_U16,
    PDU_FIELD_U32,
    PDU_FIELD_F32,
    PDU_FIELD_F64,
    PDU_FIELD_ID,
    PDU_FIELD_ENTITY_TYPE,
    PDU_FIELD_CLOCK,
    PDU_FIELD_MARKING /* 11 characters; the NUL at the end is not guaranteed */
};

struct pdu_field {
    const char *name;
    uint16_t at; /* [octets] from the start of the PDU */
    uint8_t kind;
    uint8_t count;   /* numbers side by side: 1, 3 or 6 */
    uint16_t member; /* offset in struct pdu */
};

struct pdu_layout {
    const char *name; /* "entity-state" */
    const struct pdu_field *fields;
    uint8_t field_count;
    uint8_t type, family;
    uint16_t bytes;    /* without variable parameters */
    uint16_t parts_at; /* [octets] of the count of variable parameters, 0: it has none */
};

/* Return the layout of a type, or of a name; NULL when Jolon does not know it. */
const struct pdu_layout *pdu_layout_of(uint8_t type);
const struct pdu_layout *pdu_layout_named(const char *name);

/* Returns the layouts one after another, NULL after the last. */
const struct pdu_layout *pdu_layout_at(unsigned index);

/* Returns the field of this name, NULL when there is none. */
const struct pdu_field *pdu_layout_field(const struct pdu_layout *layout, const char *name);

#endif
