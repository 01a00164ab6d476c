/* The roads of the generated ground: paths of least effort between real places. */
#ifndef JOLON_WORLD_MAKING_GENERATE_ROADS_H
#define JOLON_WORLD_MAKING_GENERATE_ROADS_H

#include "world/making/elevation_grid.h"

#include <stdint.h>

struct road_point;

/* Writes at most road_max points, 60 m apart and within the square, road after road; none in
 * water. 0, or -1 with errno ENOMEM or ENOBUFS. */
int generate_roads(const struct elevation_grid *grid, struct road_point *roads, uint32_t road_max,
                   uint32_t *road_count);

#endif
