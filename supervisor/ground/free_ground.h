/* Where plants may stand: not on roads, and not in buildings. */
#ifndef JOLON_SUPERVISOR_GROUND_FREE_GROUND_H
#define JOLON_SUPERVISOR_GROUND_FREE_GROUND_H

#include "world/terrain/ground_format.h"

#include <stdbool.h>
#include <stdint.h>

struct free_ground;

/* Notes the legs of roads, and the discs around the given middles. disc: x, z and radius [m] of
 * each. NULL: no memory. */
struct free_ground *free_ground_make(double side_m, const struct ground_road_point *roads,
                                     uint32_t road_points, double (*disc)[3], uint32_t discs);
void free_ground_free(struct free_ground *ground);

/* Returns true if a plant of this radius may stand at a place within the square: its edge is
 * FREE_GROUND_ROAD_M from the middle of roads, and outside of discs. */
#define FREE_GROUND_ROAD_M 6.0
bool free_ground_is(const struct free_ground *ground, double x, double z, double radius_m);

#endif
