/* The records of all strips by column, for frames with many queries. A query of the bins reads all
 * records of a strip; here it reads only those that may begin within its reach.
 *
 * In the first frame of a world every row is queried. With 1,000,000 rows a strip has 2,500. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_QUERY_INDEX_H
#define JOLON_COLLIDER_BROAD_PHASE_QUERY_INDEX_H

#include "collider/broad_phase/strip_bins.h"

#include <stdbool.h>
#include <stdint.h>

#define QUERY_INDEX_COLUMN_BITS 17u /* a column is 256 m wide */
#define QUERY_INDEX_COLUMNS     (((uint32_t)BIN_LAST >> QUERY_INDEX_COLUMN_BITS) + 1)

struct query_index {
    struct bin_record *record; /* [capacity] by strip, and by the column of their west edge */
    uint32_t *first;           /* [STRIP_COUNT][QUERY_INDEX_COLUMNS] and the end: index of record */
    uint32_t capacity;
    int32_t widest; /* [steps] the widest record */
    bool built;
};

/* For up to this many rows in two strips each. Returns 0, or -1 with errno ENOMEM; must be freed in
 * either case. */
int query_index_init(struct query_index *index, uint32_t rows);
void query_index_free(struct query_index *index);

/* Takes the pages of so many rows in one strip each from the kernel before the first frame. */
void query_index_touch(const struct query_index *index, uint32_t rows);

/* Builds the index of one worker's bins after the other. Does nothing if there are more records
 * than it can hold: built then stays false. */
void query_index_build(struct query_index *index, const struct strip_bins *const *bins,
                       uint32_t count);

/* Returns all records of a strip, and how many there are. */
const struct bin_record *query_index_strip(const struct query_index *index, uint32_t strip,
                                           uint32_t *count);

/* Returns the end of the records of a strip that begin in the column of x [steps] or before it. */
const struct bin_record *query_index_end(const struct query_index *index, uint32_t strip,
                                         int32_t x);

/* Returns the records of a strip that begin where a record with these edges [steps] may meet them,
 * and how many there are. */
const struct bin_record *query_index_from(const struct query_index *index, uint32_t strip,
                                          int32_t min_x, int32_t max_x, uint32_t *count);

#endif
