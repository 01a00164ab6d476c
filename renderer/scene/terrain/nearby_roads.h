/* The roads near a block of texels. */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_NEARBY_ROADS_H
#define JOLON_RENDERER_SCENE_TERRAIN_NEARBY_ROADS_H

#include <stdbool.h>
#include <stdint.h>

struct road_index;

/* Fills off[row * stride + column] with the distance [m] of each texel from the middle of the
 * nearest road, or with more than reach_m if no road is that near. The first texel is at (x, z),
 * the others are step_m apart. roads: of the world; NULL: there are none. Returns false and leaves
 * off untouched if no road is near any texel. */
bool nearby_roads_distances(const struct road_index *roads, double x, double z, double step_m,
                            uint32_t columns, uint32_t rows, uint32_t stride, double reach_m,
                            float *off);

#endif
