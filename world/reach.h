/* The reach of every gridsquare: which fixed objects overlap it (thesis row 37). Genesis only. */
#ifndef JOLON_WORLD_REACH_H
#define JOLON_WORLD_REACH_H

#include "world/fixed.h"

#include <stdint.h>

/* Builds start [SQUARE_COUNT + 1] and items [start[SQUARE_COUNT]] on the heap; the caller frees
 * both. Objects ascend within a square. 0, or -1 with errno ENOMEM. */
int reach_build(const struct fixed_object *objects, uint32_t count, uint32_t **start,
                uint32_t **items);

#endif
