/* The colour of the ground, seen from above: cover, slope, height, roads, craters and light. It is
 * the same for the ground under the camera and for the map. Pure: a texture of the same place is
 * the same at every size, except for the detail that it can hold. */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_COLOUR_H
#define JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_COLOUR_H

#include "renderer/scene/frame/frame_view.h"

#include <stdbool.h>
#include <stdint.h>

struct road_index;

/* Alpha of a texel: water, higher nearer to the sea's shore, or ground with the share of scrub in
 * its fine texture. */
#define TERRAIN_COLOUR_WATER_ALPHA  0
#define TERRAIN_COLOUR_SHORE_ALPHA  64
#define TERRAIN_COLOUR_GROUND_ALPHA 96 /* bare grass; 255 is scrub only */

#define TERRAIN_COLOUR_CRATER_REACH 2.6 /* radius of a crater's soot over the crater's radius */

struct terrain_colour_tile {
    double x, z;   /* [m, world] centre of the first texel */
    double step_m; /* between texels */
    uint32_t columns, rows;
    struct vec3 sun;                /* unit; towards the light */
    double relief;                  /* factor on the slopes for shading */
    uint8_t *rgba;                  /* [rows * columns * 4], from the north-west */
    float *light;                   /* [rows * columns] scratch: the sun's light */
    const struct road_index *roads; /* of the world; NULL: none are drawn */
};

/* Computes the texture. Returns true if there is sea in it or next to it. */
bool terrain_colour_ground(const struct world *world, const struct crater_index *craters,
                           const struct terrain_colour_tile *tile);

#endif
