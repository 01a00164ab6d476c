/* The colour of the ground, seen from above: cover, slope and height, roads, craters, light. One
 * painter for the ground under the camera and for the map, so that both show the same country.
 * Pure; a picture of the same place is the same at every size but for the detail it can hold. */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_COLOUR_H
#define JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_COLOUR_H

#include "renderer/scene/frame/frame_view.h"

#include <stdbool.h>
#include <stdint.h>

/* Alpha of a texel: water, more the nearer to the sea's shore, or ground with the share of scrub in
 * its fine texture. */
#define TERRAIN_COLOUR_WATER_ALPHA  0
#define TERRAIN_COLOUR_SHORE_ALPHA  64
#define TERRAIN_COLOUR_GROUND_ALPHA 96 /* bare grass; 255 is all scrub */

#define TERRAIN_COLOUR_CRATER_REACH 2.6 /* of a crater's radius: how far its soot lies */

struct terrain_colour_tile {
    double x, z;   /* [m, world] centre of the first texel */
    double step_m; /* between texels */
    uint32_t columns, rows;
    struct vec3 sun; /* unit; where the light comes from */
    double relief;   /* slopes are shaded as if so much steeper: 1 is true */
    uint8_t *rgba;   /* [rows * columns * 4], from the north-west */
    float *light;    /* [rows * columns] scratch */
};

/* Returns whether there is sea in it or next to it. */
bool terrain_colour_ground(const struct world *world, const struct crater_index *craters,
                           const struct terrain_colour_tile *tile);

#endif
