/* The table of the types of DIS and of Cursor on Target for our kinds, from a text file
 * (config/dis/types.txt, which explains its rows). It is read before the sandbox is entered. */
#ifndef JOLON_GATEWAY_TYPE_TABLE_H
#define JOLON_GATEWAY_TYPE_TABLE_H

#include "gateway/pdu/pdu.h"
#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/runtime/error_text.h"

#include <stdbool.h>

#define TYPE_TABLE_COT 24u /* room for a type of Cursor on Target with its NUL */
#define TYPE_TABLE_INS 256u

struct type_row {
    struct pdu_entity_type type;
    uint16_t warhead, fuse;   /* munitions */
    char cot[TYPE_TABLE_COT]; /* the type of Cursor on Target behind "a-f-"; "": none */
    bool given;
    bool nearest; /* the kind has no row: this is that of its domain */
};

/* A type that is shown as a kind when it comes in, and is never sent. */
struct type_in {
    struct pdu_entity_type type;
    uint16_t kind;
};

struct type_table {
    struct type_row row[KIND_COUNT_MAX][FORCE_COUNT];
    struct type_in in[TYPE_TABLE_INS];
    uint32_t ins;
    bool munition[KIND_COUNT_MAX];
};

/* Reads the file. Returns 0, or -1 with file, line and what would be right. Every kind that moves
 * has a row then. */
int type_table_read(struct type_table *table, const char *path, const struct kind *kinds,
                    uint32_t kind_count, struct error_text *error);

/* Returns the row of a kind and a force, and an empty one for a kind that does not exist. */
const struct type_row *type_table_row(const struct type_table *table, uint16_t kind, uint8_t force);

/* Returns the kind that a type of DIS is shown as, KIND_NONE when none fits: kind and domain of the
 * type must be those of a row. Of the rows that fit, the one with the same category is chosen, of
 * these the one with most of subcategory, country, specific and extra in common, in this order of
 * importance, and of equal ones the first kind. A subcategory counts within its category alone, as
 * its numbers mean nothing in another, specific within the subcategory, and extra within that. A
 * type of a category that no row has is what the row "in" of category 0 says. munition: whether the
 * type is one of munitions. *same: the whole type is in the table. */
uint16_t type_table_kind(const struct type_table *table, struct pdu_entity_type type, bool munition,
                         bool *same);

#endif
