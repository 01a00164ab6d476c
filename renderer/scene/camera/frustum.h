/* The camera's frustum, prepared for frequent tests of balls relative to the eye: in float, without
 * a root or a division. Pure. */
#ifndef JOLON_RENDERER_SCENE_CAMERA_FRUSTUM_H
#define JOLON_RENDERER_SCENE_CAMERA_FRUSTUM_H

#include "renderer/scene/camera/camera.h"

#include <stdbool.h>

struct frustum {
    float forward[3], right[3], up[3]; /* unit, world */
    float tan_x, tan_y;                /* of half the fields of view */
    float cos_x, cos_y;
    float far_m;
    float near_m;
    float focal_pixels; /* size of a metre at a distance of a metre [pixel] */
};

static inline struct frustum frustum_of(const struct camera *camera)
{
    struct frustum frustum = {
        .tan_x = (float)camera->tan_x,
        .tan_y = (float)camera->tan_y,
        .cos_x = (float)(1.0 / sqrt(1.0 + camera->tan_x * camera->tan_x)),
        .cos_y = (float)(1.0 / sqrt(1.0 + camera->tan_y * camera->tan_y)),
        .far_m = (float)camera->far_m,
        .near_m = (float)camera->near_m,
        .focal_pixels = (float)camera->focal_pixels,
    };
    vec3_to_floats(frustum.forward, camera->forward);
    vec3_to_floats(frustum.right, camera->right);
    vec3_to_floats(frustum.up, camera->up);
    return frustum;
}

static inline float frustum_dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Returns true if any part of the ball may be in the picture. False is certain. at: relative to the
 * eye. */
static inline bool frustum_ball(const struct frustum *frustum, const float at[3], float radius_m)
{
    float depth = frustum_dot(at, frustum->forward), far = frustum->far_m + radius_m;
    float x = fabsf(frustum_dot(at, frustum->right)), y = fabsf(frustum_dot(at, frustum->up));
    return depth >= -radius_m && depth <= far &&
           (x - depth * frustum->tan_x) * frustum->cos_x <= radius_m &&
           (y - depth * frustum->tan_y) * frustum->cos_y <= radius_m;
}

/* Returns the size of a length at a distance [pixel]. */
static inline float frustum_pixels(const struct frustum *frustum, float length_m, float distance_m)
{
    return length_m * frustum->focal_pixels / fmaxf(distance_m, frustum->near_m);
}

#endif
