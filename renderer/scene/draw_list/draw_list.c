/* Bodies of the draw list: their level of detail, place, shadow and order. */
#include "renderer/scene/draw_list/draw_list.h"

#include "renderer/scene/frame/light.h"
#include "world/terrain/terrain.h"
#include "world/world.h"

#include <stdlib.h>

#define SHADOW_MIN_PIXELS 6.0
#define SHADOW_RANGE_M    2500.0
#define SHADOW_LIFT_M     0.06 /* above the ground, so that it does not sink in */

enum mesh_detail draw_list_detail(double pixels, bool bent)
{
    if (bent && pixels > BENT_MIN_PIXELS)
        return MESH_FINE;
    if (pixels > MESH_FULL_PIXELS)
        return MESH_FULL;
    if (pixels > MESH_MIDDLE_PIXELS)
        return MESH_MIDDLE;
    return pixels > MESH_COARSE_PIXELS ? MESH_COARSE : MESH_COARSEST;
}

static void copy_axis(float to[3], struct vec3 from, double scale)
{
    to[0] = (float)(from.x * scale);
    to[1] = (float)(from.y * scale);
    to[2] = (float)(from.z * scale);
}

struct draw_list_body *draw_list_add_body(struct draw_list *list, uint16_t model,
                                          enum mesh_detail detail)
{
    if (list->body_count == DRAW_LIST_BODIES_MAX) {
        list->omitted++;
        return NULL;
    }
    uint32_t i = list->body_count++;
    list->instances[i] = (struct draw_list_instance){.model = model, .detail = (uint8_t)detail};
    list->bodies[i] = (struct draw_list_body){.burn = 0.0f};
    return &list->bodies[i];
}

void draw_list_place_body(const struct draw_list *list, struct draw_list_body *body,
                          struct vec3 position, const struct body_axes *axes, double scale)
{
    draw_list_relative(list, position, body->at);
    copy_axis(body->forward, axes->forward, scale);
    copy_axis(body->up, axes->up, scale);
    copy_axis(body->right, axes->right, scale);
}

/* Finds the plane of the ground where the body's shadow falls, along the sun's light. */
void draw_list_add_shadow(struct draw_list *list, const struct frame_view *frame_view,
                          struct vec3 position, double pixels)
{
    const struct terrain *terrain = &frame_view->world->terrain;
    struct draw_list_body *body = &list->bodies[list->body_count - 1];
    struct vec3 foot = position;
    if (pixels <= SHADOW_MIN_PIXELS ||
        vec3_length(vec3_sub(position, list->camera.eye)) >= SHADOW_RANGE_M)
        return;
    for (uint32_t i = 0; i < 3; i++) {
        double ground = terrain_height(terrain, frame_view->craters, foot.x, foot.z);
        double down = (position.y - ground) / SUN_Y;
        foot.x = position.x - SUN_X * down;
        foot.z = position.z - SUN_Z * down;
        foot.y = ground;
    }
    struct vec3 normal = terrain_normal(terrain, frame_view->craters, foot.x, foot.z);
    if (vec3_dot(normal, light_sun()) < 0.1)
        return;
    copy_axis(body->plane, normal, 1.0);
    struct vec3 relative = vec3_sub(foot, list->camera.eye);
    body->plane[3] = (float)(vec3_dot(normal, relative) + SHADOW_LIFT_M);
    list->instances[list->body_count - 1].shadow = 1;
}

static int by_model(const void *a, const void *b)
{
    const struct body_order *x = a, *y = b;
    if (x->instance.model != y->instance.model)
        return x->instance.model < y->instance.model ? -1 : 1;
    if (x->instance.detail != y->instance.detail)
        return x->instance.detail < y->instance.detail ? -1 : 1;
    return (x->index > y->index) - (x->index < y->index);
}

static void swap_bodies(struct draw_list *list, uint32_t a, uint32_t b)
{
    struct draw_list_body body = list->bodies[a];
    list->bodies[a] = list->bodies[b];
    list->bodies[b] = body;
    struct draw_list_instance instance = list->instances[a];
    list->instances[a] = list->instances[b];
    list->instances[b] = instance;
}

void draw_list_sort_bodies(struct draw_list *list)
{
    uint32_t count = list->body_count;
    for (uint32_t i = 0; i < count; i++)
        list->order[i] = (struct body_order){list->instances[i], i};
    qsort(list->order, count, sizeof *list->order, by_model);
    /* The bodies are swapped in place, one cycle of the permutation after another. */
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = i;
        while (list->order[at].index != i) {
            uint32_t from = list->order[at].index;
            swap_bodies(list, at, from);
            list->order[at].index = at;
            at = from;
        }
        list->order[at].index = at;
    }
}
