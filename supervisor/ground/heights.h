/* The heights of a ground, from rasters. */
#ifndef JOLON_SUPERVISOR_GROUND_HEIGHTS_H
#define JOLON_SUPERVISOR_GROUND_HEIGHTS_H

#include "supervisor/ground/raster.h"

#include <stddef.h>

struct thread_pool;

/* Voids up to so far from known heights on both sides are interpolated [m]. */
#define HEIGHTS_FILL_M 500.0

struct heights_counts {
    uint64_t *from;  /* [count] posts with heights of each raster */
    uint64_t filled; /* interpolated, */
    size_t first;    /* and the first of them: row * side + column */
};

/* Fills posts [side * side]: each from the first raster that has all four pixels around it, in the
 * order of rasters; voids are interpolated between the nearest known heights to the west and east
 * or to the north and south. Heights are rounded as a ground file keeps them. 0, or -1 with the
 * reason and the place of a post that has none. */
int heights_fill(float *posts, const struct post_grid *grid, struct raster **rasters,
                 uint32_t count, struct thread_pool *pool, struct heights_counts *counts,
                 struct error_text *error);

#endif
