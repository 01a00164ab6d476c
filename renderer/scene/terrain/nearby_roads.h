/* The roads near a block of texels. */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_NEARBY_ROADS_H
#define JOLON_RENDERER_SCENE_TERRAIN_NEARBY_ROADS_H

#include <stdbool.h>
#include <stdint.h>

struct world;

/* Fills off[row * stride + column] with how far [m] each texel is from the middle of the nearest
 * road, or with more than reach_m where none is so near. The first texel lies at (x, z), the others
 * are step_m apart. False, and off untouched, when no road is near any. */
bool nearby_roads_near(const struct world *world, double x, double z, double step_m,
                       uint32_t columns, uint32_t rows, uint32_t stride, double reach_m,
                       float *off);

#endif
