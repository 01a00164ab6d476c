/* The look of the ground of an earthwork: packed earth, dug earth, water or wet concrete, with a
 * line of lime around it. Pure. */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_EARTHWORK_COLOUR_H
#define JOLON_RENDERER_SCENE_TERRAIN_EARTHWORK_COLOUR_H

#include "world/maths/maths.h"

#include <stdbool.h>

struct earthwork;
struct terrain;

struct earthwork_look {
    float r, g, b; /* sRGB fractions, before the light */
    float light;   /* change of the sun's light by the slopes of the works */
    bool water;
};

/* How a picture sees the ground. */
struct earthwork_view {
    struct vec3 sun; /* unit; towards the light */
    double step_m;   /* between texels */
    double relief;   /* factor on the slopes for shading */
};

/* The mesh is coarser than the steepest faces and spreads them over the ground beside the work,
 * which is painted so far from its rectangle [m]. */
#define EARTHWORK_COLOUR_MARGIN_M 0.5

/* Returns how far inside the rectangle of the work a point is [m]; negative: outside. */
double earthwork_colour_inside(const struct earthwork *work, double x, double z);

/* Returns the look of a point in the rectangle of the work or its margin. */
struct earthwork_look earthwork_colour_at(const struct terrain *terrain,
                                          const struct earthwork *work,
                                          const struct earthwork_view *view, double x, double z);

#endif
