/* The chase camera and its frustum. */
#include "renderer/scene/camera.h"

#include <cglm/cglm.h>

#include <string.h>

#define CHASE_BACK_M      25.0
#define CHASE_UP_M        9.0
#define CHASE_BEYOND_M    23.0 /* it looks at a point so far ahead of the subject */
#define CHASE_TANK_RADIUS 3.0  /* [m] the body those lengths are for */
#define CHASE_ASIDE_RAD                                                                            \
    0.24                      /* a little from the side: a body seen straight from behind is flat  \
                               */
#define CHASE_PITCH_SHARE 0.5 /* of the subject's pitch that the camera takes part in */
#define SIGHT_SAMPLES     12
#define SIGHT_CLEARANCE_M 1.0

static struct vec3 unit(struct vec3 v)
{
    return vec3_scale(v, 1.0 / vec3_length(v));
}

static void fill_matrix(struct camera *camera)
{
    mat4 projection, view;
    vec3 eye = {0.0f, 0.0f, 0.0f};
    vec3 forward = {(float)camera->forward.x, (float)camera->forward.y, (float)camera->forward.z};
    vec3 up = {(float)camera->up.x, (float)camera->up.y, (float)camera->up.z};
    glm_perspective((float)(2.0 * atan(camera->tan_y)),
                    (float)camera->width / (float)camera->height, (float)camera->near_m,
                    (float)camera->far_m, projection);
    glm_look(eye, forward, up, view);
    mat4 product;
    glm_mat4_mul(projection, view, product);
    memcpy(camera->matrix, product, sizeof camera->matrix);
}

void camera_look(struct camera *camera, struct vec3 eye, struct vec3 target, uint32_t width,
                 uint32_t height)
{
    camera->eye = eye;
    camera->forward = unit(vec3_sub(target, eye));
    camera->right = unit(vec3_cross(camera->forward, (struct vec3){0.0, 1.0, 0.0}));
    camera->up = vec3_cross(camera->right, camera->forward);
    camera->width = width;
    camera->height = height;
    /* The field of view is that of a 16:9 picture; others see the same height of the world. */
    camera->tan_y = tan(0.5 * CAMERA_FIELD_OF_VIEW_RAD) * 9.0 / 16.0;
    camera->tan_x = camera->tan_y * (double)width / (double)height;
    camera->near_m = 1.0;
    camera->far_m = CAMERA_FAR_M;
    camera->focal_pixels = 0.5 * (double)height / camera->tan_y;
    fill_matrix(camera);
}

void camera_chase(struct camera *camera, const struct camera_subject *subject,
                  const struct terrain *terrain, const struct crater_index *craters, uint32_t width,
                  uint32_t height)
{
    double scale = maths_clamp(subject->radius_m / CHASE_TANK_RADIUS, 0.75, 12.0);
    double away = subject->heading_rad + CHASE_ASIDE_RAD;
    double tilt = CHASE_PITCH_SHARE * subject->pitch_rad;
    struct vec3 p = subject->position;
    struct vec3 eye = {p.x - maths_sin(away) * CHASE_BACK_M * scale,
                       p.y + (CHASE_UP_M - CHASE_BACK_M * maths_sin(tilt)) * scale,
                       p.z + maths_cos(away) * CHASE_BACK_M * scale};
    struct vec3 target = {p.x + maths_sin(subject->heading_rad) * CHASE_BEYOND_M * scale,
                          p.y + (1.0 + CHASE_BEYOND_M * maths_sin(tilt)) * scale,
                          p.z - maths_cos(subject->heading_rad) * CHASE_BEYOND_M * scale};

    double floor_m = terrain_height(terrain, craters, eye.x, eye.z) + CAMERA_CLEARANCE_M;
    eye.y = maths_max(eye.y, floor_m);
    /* Ground between the eye and the subject lifts the eye until it sees over it. */
    for (int32_t i = 1; i < SIGHT_SAMPLES; i++) {
        double t = (double)i / SIGHT_SAMPLES; /* 0 at the eye, 1 at the subject */
        struct vec3 on = vec3_lerp(eye, p, t);
        double ground = terrain_height(terrain, craters, on.x, on.z) + SIGHT_CLEARANCE_M * (1 - t);
        if (on.y < ground)
            eye.y += (ground - on.y) / (1.0 - t);
    }
    camera_look(camera, eye, target, width, height);
}

bool camera_sees(const struct camera *camera, struct vec3 centre, double radius_m)
{
    struct vec3 to = vec3_sub(centre, camera->eye);
    double depth = vec3_dot(to, camera->forward);
    if (depth < -radius_m || depth > camera->far_m + radius_m)
        return false;
    /* Distance outside the side planes, whose normals are (1, tan) scaled to a unit. */
    double x = fabs(vec3_dot(to, camera->right)), y = fabs(vec3_dot(to, camera->up));
    double over_x = (x - depth * camera->tan_x) / sqrt(1.0 + camera->tan_x * camera->tan_x);
    double over_y = (y - depth * camera->tan_y) / sqrt(1.0 + camera->tan_y * camera->tan_y);
    return over_x <= radius_m && over_y <= radius_m;
}

/* Does the box lie wholly on the outer side of a plane through the eye? */
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
