/* The boxes around what is left of the stretches of vehicles that cruise (world/entity/cruise.h),
 * by cell of the map. An entry stays until its vehicle ends its stretch, so a frame costs what
 * begins, ends and is asked for. The box of an entry is that of the frame in which it was added: it
 * holds all boxes of the same stretch that follow.
 *
 * Short boxes, those of most land vehicles, have small cells, and long ones, of aircraft, large
 * ones. A query looks as far beyond its own box as the longest box of the layer reaches.
 *
 * This is a cache of one process. Queries may find more rows than those whose stretch is in the
 * way; the caller compares the boxes of the frame. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_CRUISE_INDEX_H
#define JOLON_COLLIDER_BROAD_PHASE_CRUISE_INDEX_H

#include "collider/motion/pair_filter.h"

#include <stdint.h>

struct cruise_entry {
    struct path_box box;
    uint32_t next, before; /* rows in the same cell, + 1; 0: none */
};

struct cruise_layer {
    uint32_t *first; /* [side * side] a row + 1; 0: the cell is empty */
    uint32_t side;   /* cells along an edge of the world */
    uint32_t count;  /* rows that are held */
    float cells_a_m;
    float longest_m; /* the longest side of a box so far */
};

#define CRUISE_LAYERS 2 /* short boxes, long ones */

struct cruise_index {
    struct cruise_entry *entry; /* [rows] of the rows that are held */
    struct cruise_layer layer[CRUISE_LAYERS];
    uint64_t *held; /* a bit for each row */
    uint32_t words; /* of held */
    uint32_t count; /* rows that are held */
};

/* For up to so many rows in a world of this side [m]. Returns 0, or -1 with errno ENOMEM; must be
 * freed in either case. */
int cruise_index_init(struct cruise_index *index, uint32_t rows, double world_m);
void cruise_index_free(struct cruise_index *index);

/* Takes the pages of so many rows from the kernel before the first frame. */
void cruise_index_touch(const struct cruise_index *index, uint32_t rows);

/* Adds a row that is not held, or takes out one that is. One thread. */
void cruise_index_add(struct cruise_index *index, uint32_t row, const struct path_box *box);
void cruise_index_remove(struct cruise_index *index, uint32_t row);

/* Takes out all rows. */
void cruise_index_clear(struct cruise_index *index);

static inline bool cruise_index_holds(const struct cruise_index *index, uint32_t row)
{
    return index->held[row / 64] >> row % 64 & 1;
}

/* Adds to the list every row but one whose box meets this box on the map, as a pair of both, the
 * lower row first. Any thread, while nothing changes the index. */
void cruise_index_pairs(const struct cruise_index *index, uint32_t row, const struct path_box *box,
                        struct pair_list *pairs);

/* Adds to the list every row whose box meets this box on the map, as pair.a; pair.b is 0. */
void cruise_index_query(const struct cruise_index *index, const struct path_box *box,
                        struct pair_list *found);

#endif
