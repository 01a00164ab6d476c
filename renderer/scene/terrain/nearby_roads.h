/* The roads near a block of texels. */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_NEARBY_ROADS_H
#define JOLON_RENDERER_SCENE_TERRAIN_NEARBY_ROADS_H

#include <stdbool.h>
#include <stdint.h>

struct world;

#define NEARBY_ROADS_MAX 1024u

/* The stretches of roads near a tile, each by the number of the point where it begins. */
struct nearby_roads {
    uint32_t stretches[NEARBY_ROADS_MAX];
    uint32_t count;
    bool too_many; /* there are more: each block looks at all roads of the world */
};

/* Finds the stretches whose bounds touch the rectangle from (x0, z0) to (x1, z1) [m]. */
void nearby_roads_find(struct nearby_roads *roads, const struct world *world, double x0, double z0,
                       double x1, double z1);

/* Fills off[row * stride + column] with the distance [m] of each texel from the middle of the
 * nearest road, or with more than reach_m if no road is that near. The first texel is at (x, z),
 * the others are step_m apart; roads were found in a rectangle that holds them and reach_m around
 * them. Returns false and leaves off untouched if no road is near any texel. */
bool nearby_roads_distances(const struct nearby_roads *roads, const struct world *world, double x,
                            double z, double step_m, uint32_t columns, uint32_t rows,
                            uint32_t stride, double reach_m, float *off);

#endif
