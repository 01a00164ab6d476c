/* Where the ground is in nobody's way: gridsquares without water whose steepest slope is known.
 * Most ways ahead lie in these, and need no look at the ground itself. */
#ifndef JOLON_MOVER_QUERY_SLOPE_MAX_MAP_H
#define JOLON_MOVER_QUERY_SLOPE_MAX_MAP_H

#include "mover/query/ground_marks.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#define SLOPE_MAX_MAP_STEP 0.02 /* of a slope's tangent */

/* Filled as squares are asked for: all of a world at once would take a mover's start too long. */
struct slope_max_map {
    const struct terrain *terrain;
    _Atomic uint8_t *steps; /* [GRIDSQUARE_COUNT] of SLOPE_MAX_MAP_STEP, never below the square's
                               steepest slope without craters, plus 1; UINT8_MAX: water, or cliffs;
                               0: not looked at yet */
};

/* 0, or -1 with errno ENOMEM. The terrain stays the caller's. */
int slope_max_map_init(struct slope_max_map *map, const struct terrain *terrain);
void slope_max_map_free(struct slope_max_map *map);

/* Is the ground from (x0, z0) to (x1, z1), both in the world, surely dry, without craters, and
 * everywhere less steep than slope (a tangent) by half an SLOPE_MAX_MAP_STEP at least? May be false
 * when it is. Any thread; what it tells does not depend on what was asked before. */
bool slope_max_map_between(const struct slope_max_map *map, const struct ground_marks *marks,
                           double x0, double z0, double x1, double z1, double slope);

#endif
