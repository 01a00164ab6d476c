/* Suitability of the terrain for trees and bushes. */
#ifndef JOLON_WORLD_MAKING_PLANT_SUITABILITY_H
#define JOLON_WORLD_MAKING_PLANT_SUITABILITY_H

#include "world/making/elevation_grid.h"

/* Fills forest and chaparral from the heights, streams and the distance from the sea. 0, or -1 with
 * errno ENOMEM. */
int plant_suitability_fill(struct elevation_grid *grid, uint64_t seed);

#endif
