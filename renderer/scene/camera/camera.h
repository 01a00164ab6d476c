/* The camera: where a picture is taken from, and what part of the world it sees. Pure.
 *
 * Positions are in double precision. The matrix takes metres relative to the eye, so that float is
 * precise enough in a world of 50 km. */
#ifndef JOLON_RENDERER_SCENE_CAMERA_CAMERA_H
#define JOLON_RENDERER_SCENE_CAMERA_CAMERA_H

#include "world/terrain/terrain.h"

#include <stdbool.h>
#include <stdint.h>

#define CAMERA_FIELD_OF_VIEW_RAD (60.0 * RAD_PER_DEG) /* from left to right at 16:9 */
#define CAMERA_NEAR_M            1.0
#define CAMERA_FAR_M             90000.0

/* The lens of a camera. */
struct camera_lens {
    double field_rad;       /* from left to right of a 16:9 picture */
    double near_m;          /* distance of the near plane */
    uint32_t width, height; /* [pixel] of the picture */
};

struct camera {
    struct vec3 eye;                /* [m, world] */
    struct vec3 forward, right, up; /* unit, world */
    double tan_x, tan_y;            /* of half the fields of view */
    double near_m, far_m;
    uint32_t width, height; /* [pixel] */
    double focal_pixels;    /* size of a metre at a distance of a metre [pixel] */
    float matrix[16];       /* eye-relative metres to clip space, column by column */
};

/* Looks along forward, turned so that up points up in the picture. Neither vector needs unit
 * length, nor must they be perpendicular, but they must not be parallel. */
void camera_turn(struct camera *camera, struct vec3 eye, struct vec3 forward, struct vec3 up,
                 const struct camera_lens *lens);

/* Looks from eye to target with a level horizon. Straight down or up, north is at the picture's top
 * or bottom. */
void camera_look_through(struct camera *camera, struct vec3 eye, struct vec3 target,
                         const struct camera_lens *lens);

/* The same with the standard lens. */
void camera_look(struct camera *camera, struct vec3 eye, struct vec3 target, uint32_t width,
                 uint32_t height);

/* Returns true if any part of the ball may be in the picture. False is certain. */
bool camera_sees(const struct camera *camera, struct vec3 centre, double radius_m);

/* The same for a box along the world's axes. It is more precise for large flat boxes. */
bool camera_sees_box(const struct camera *camera, struct vec3 low, struct vec3 high);

/* Returns the size of a length at a distance [pixel]. */
static inline double camera_pixels(const struct camera *camera, double length_m, double distance_m)
{
    return length_m * camera->focal_pixels / maths_max(distance_m, camera->near_m);
}

#endif
