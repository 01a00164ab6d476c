/* The fixed objects for the broad phase: for each strip of gridsquares the objects that reach into
 * it, from west to east, so that none near a border is missed (thesis row 37). Built once from the
 * world, since fixed objects never move. Read-only afterwards; any thread. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_STATIC_BOXES_H
#define JOLON_COLLIDER_BROAD_PHASE_STATIC_BOXES_H

#include "collider/broad_phase/strip_bins.h"

#include <stdint.h>

struct fixed_object;
struct world;

#define STATIC_BOXES_COLUMN_BITS 18 /* columns of 512 m, in steps */
#define STATIC_BOXES_COLUMNS     (1 << (BIN_BITS - STATIC_BOXES_COLUMN_BITS))

#define STATIC_BOXES_AHEAD 4 /* records that may be read behind any record of a strip */

struct static_boxes {
    float steps_per_m; /* bin_steps_per_m() */
    /* By strip, then by min_x; each strip ends with STATIC_BOXES_AHEAD records that lie east of
     * everything. */
    struct bin_record *record;
    uint32_t start[STRIP_COUNT + 1];
    /* [STRIP_COUNT][STATIC_BOXES_COLUMNS] the first record that reaches into the column or lies
     * beyond it */
    uint32_t *first;
};

/* Returns 0, or -1 with errno ENOMEM. */
int static_boxes_init(struct static_boxes *fixed_boxes, const struct world *world);
void static_boxes_free(struct static_boxes *fixed_boxes);

/* Returns the first strip that the object reaches into. */
uint32_t static_boxes_strip(const struct static_boxes *fixed_boxes, const struct world *world,
                            const struct fixed_object *object);

/* Returns the strip's records from the first that can reach x [steps] on. The record that ends them
 * lies beyond every max_x. */
static inline const struct bin_record *static_boxes_from(const struct static_boxes *fixed_boxes,
                                                         uint32_t strip, int32_t x)
{
    uint32_t column = (uint32_t)x >> STATIC_BOXES_COLUMN_BITS;
    return fixed_boxes->record + fixed_boxes->first[strip * STATIC_BOXES_COLUMNS + column];
}

#endif
