/* Cameras and culling. */
#include "renderer/scene/camera/camera.h"

#include <stddef.h>

#define LEVEL_MIN 1e-6 /* a direction with a smaller horizontal share is vertical */

static struct vec3 unit(struct vec3 v)
{
    return vec3_scale(v, 1.0 / vec3_length(v));
}

/* The perspective projection of OpenGL, for positions relative to the eye. */
static void fill_matrix(struct camera *camera)
{
    double deep = camera->far_m - camera->near_m;
    double scale = (camera->far_m + camera->near_m) / deep;
    struct vec3 row[4] = {
        vec3_scale(camera->right, 1.0 / camera->tan_x),
        vec3_scale(camera->up, 1.0 / camera->tan_y),
        vec3_scale(camera->forward, scale),
        camera->forward,
    };
    for (uint32_t i = 0; i < 4; i++) {
        camera->matrix[i] = (float)row[i].x;
        camera->matrix[4 + i] = (float)row[i].y;
        camera->matrix[8 + i] = (float)row[i].z;
        camera->matrix[12 + i] = 0.0f;
    }
    camera->matrix[14] = (float)(-2.0 * camera->far_m * camera->near_m / deep);
}

void camera_turn(struct camera *camera, struct vec3 eye, struct vec3 forward, struct vec3 up,
                 const struct camera_lens *lens)
{
    double sine, cosine;
    camera->eye = eye;
    camera->forward = unit(forward);
    camera->right = unit(vec3_cross(camera->forward, up));
    camera->up = vec3_cross(camera->right, camera->forward);
    camera->width = lens->width;
    camera->height = lens->height;
    /* The field of view is that of a 16:9 picture; other pictures have the same vertical field. */
    maths_sincos(0.5 * lens->field_rad, &sine, &cosine);
    camera->tan_y = sine / cosine * 9.0 / 16.0;
    camera->tan_x = camera->tan_y * (double)lens->width / (double)lens->height;
    camera->near_m = lens->near_m;
    camera->far_m = CAMERA_FAR_M;
    camera->focal_pixels = 0.5 * (double)lens->height / camera->tan_y;
    fill_matrix(camera);
}

void camera_look_through(struct camera *camera, struct vec3 eye, struct vec3 target,
                         const struct camera_lens *lens)
{
    struct vec3 forward = vec3_sub(target, eye);
    double level = forward.x * forward.x + forward.z * forward.z;
    bool steep = level < LEVEL_MIN * LEVEL_MIN * vec3_dot(forward, forward);
    struct vec3 up = steep ? (struct vec3){0.0, 0.0, forward.y < 0.0 ? -1.0 : 1.0}
                           : (struct vec3){0.0, 1.0, 0.0};
    camera_turn(camera, eye, forward, up, lens);
}

void camera_look(struct camera *camera, struct vec3 eye, struct vec3 target, uint32_t width,
                 uint32_t height)
{
    const struct camera_lens lens = {CAMERA_FIELD_OF_VIEW_RAD, CAMERA_NEAR_M, width, height};
    camera_look_through(camera, eye, target, &lens);
}

bool camera_sees(const struct camera *camera, struct vec3 centre, double radius_m)
{
    struct vec3 to = vec3_sub(centre, camera->eye);
    double depth = vec3_dot(to, camera->forward);
    if (depth < -radius_m || depth > camera->far_m + radius_m)
        return false;
    /* Distance outside the side planes. Their normals are (1, tan), scaled to unit length. */
    double x = fabs(vec3_dot(to, camera->right)), y = fabs(vec3_dot(to, camera->up));
    double over_x = (x - depth * camera->tan_x) / sqrt(1.0 + camera->tan_x * camera->tan_x);
    double over_y = (y - depth * camera->tan_y) / sqrt(1.0 + camera->tan_y * camera->tan_y);
    return over_x <= radius_m && over_y <= radius_m;
}

/* Returns true if the box lies wholly on the outer side of a plane through the eye. */
static bool box_outside(struct vec3 low, struct vec3 high, struct vec3 outward)
{
    struct vec3 innermost = {outward.x > 0.0 ? low.x : high.x, outward.y > 0.0 ? low.y : high.y,
                             outward.z > 0.0 ? low.z : high.z};
    return vec3_dot(innermost, outward) > 0.0;
}

bool camera_sees_box(const struct camera *camera, struct vec3 low, struct vec3 high)
{
    low = vec3_sub(low, camera->eye);
    high = vec3_sub(high, camera->eye);
    struct vec3 across = vec3_scale(camera->forward, -camera->tan_x);
    struct vec3 upward = vec3_scale(camera->forward, -camera->tan_y);
    const struct vec3 planes[] = {
        vec3_scale(camera->forward, -1.0), vec3_add(across, camera->right),
        vec3_sub(across, camera->right),   vec3_add(upward, camera->up),
        vec3_sub(upward, camera->up),
    };
    for (size_t i = 0; i < sizeof planes / sizeof planes[0]; i++)
        if (box_outside(low, high, planes[i]))
            return false;
    return true;
}
