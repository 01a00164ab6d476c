/* The camera: where the picture is taken from, and what of the world can be in it. Pure.
 *
 * Positions stay in double precision; the matrix takes metres relative to the eye, so that 50 km
 * of world lose nothing in float. */
#ifndef JOLON_RENDERER_SCENE_CAMERA_CAMERA_H
#define JOLON_RENDERER_SCENE_CAMERA_CAMERA_H

#include "world/terrain/terrain.h"

#include <stdbool.h>
#include <stdint.h>

#define CAMERA_FIELD_OF_VIEW_RAD (60.0 * RAD_PER_DEG) /* from left to right at 16:9 */
#define CAMERA_NEAR_M            1.0
#define CAMERA_FAR_M             90000.0

/* What a camera sees through. */
struct camera_lens {
    double field_rad;       /* from left to right of a 16:9 picture */
    double near_m;          /* nothing nearer is seen */
    uint32_t width, height; /* [pixel] of the picture */
};

struct camera {
    struct vec3 eye;                /* [m, world] */
    struct vec3 forward, right, up; /* unit, world */
    double tan_x, tan_y;            /* of half the fields of view */
    double near_m, far_m;
    uint32_t width, height; /* [pixel] */
    double focal_pixels;    /* a metre at a metre's distance */
    float matrix[16];       /* eye-relative metres to clip space, column by column */
};

/* Looks ahead along forward, turned so that up is up in the picture; neither need be a unit, nor
 * need they stand upright on each other, but they must not be parallel. */
void camera_turn(struct camera *camera, struct vec3 eye, struct vec3 forward, struct vec3 up,
                 const struct camera_lens *lens);

/* Looks from eye to target, level; straight down or up, north is at the picture's top or bottom. */
void camera_look_through(struct camera *camera, struct vec3 eye, struct vec3 target,
                         const struct camera_lens *lens);

/* The same through the usual lens. */
void camera_look(struct camera *camera, struct vec3 eye, struct vec3 target, uint32_t width,
                 uint32_t height);

/* Can any of this ball be in the picture? Never false for one that is. */
bool camera_sees(const struct camera *camera, struct vec3 centre, double radius_m);

/* The same for a box with edges along the world's axes; sharper for large flat ones. */
bool camera_sees_box(const struct camera *camera, struct vec3 low, struct vec3 high);

/* How large a length shows at a distance [pixel]. */
static inline double camera_pixels(const struct camera *camera, double length_m, double distance_m)
{
    return length_m * camera->focal_pixels / maths_max(distance_m, camera->near_m);
}

#endif
