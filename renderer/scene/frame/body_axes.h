/* The axes of a body in the world: x forward, y up, z right (world/world.h). */
#ifndef JOLON_RENDERER_SCENE_FRAME_BODY_AXES_H
#define JOLON_RENDERER_SCENE_FRAME_BODY_AXES_H

#include "world/maths/maths.h"

struct body_axes {
    struct vec3 forward, up, right; /* unit, world */
};

/* heading clockwise from north, pitch nose up, roll right side down [rad]. */
static inline struct body_axes body_axes_of(double heading, double pitch, double roll)
{
    double sh, ch, sp, cp, sr, cr;
    maths_sincos(heading, &sh, &ch);
    maths_sincos(pitch, &sp, &cp);
    maths_sincos(roll, &sr, &cr);
    struct vec3 level_right = {ch, 0.0, sh};
    struct vec3 level_up = {-sh * sp, cp, ch * sp};
    return (struct body_axes){
        .forward = {sh * cp, sp, -ch * cp},
        .up = vec3_add(vec3_scale(level_up, cr), vec3_scale(level_right, sr)),
        .right = vec3_sub(vec3_scale(level_right, cr), vec3_scale(level_up, sr)),
    };
}

#endif
