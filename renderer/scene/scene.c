/* Vehicles and munitions, and the order in which the lists are filled. */
#include "renderer/scene/scene.h"

#include "renderer/scene/noise/value_noise.h"
#include "renderer/scene/frame/light.h"
#include "renderer/scene/frame/body_axes.h"
#include "renderer/scene/terrain/terrain_tiles.h"
#include "renderer/scene/plants/grass.h"
#include "renderer/scene/plants/plants.h"
#include "renderer/scene/particles/debris.h"
#include "renderer/scene/particles/particle_emitters.h"
#include "renderer/scene/particles/rotors.h"
#include "renderer/scene/fixed_objects.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <stdlib.h>
#include <string.h>

#define ROTOR_HZ         4.6 /* turns a second */
#define BURN_LOW         0.12f
#define BURN_MED         0.28f
#define BURN_HIGH        0.5f
#define BROKEN_HEIGHT    0.35  /* of a body that has broken up, over its height before */
#define DENT_MIN_REACH_M 0.55f /* sheet metal bends at least this far around a dent ... */
#define DENT_REACH       2.2f  /* ... plus this many times the dent's depth */

static const float force_colours[FORCE_COUNT][3] = {
    [FORCE_NEUTRAL] = {0.54f, 0.53f, 0.44f},
    [FORCE_BLUE] = {0.17f, 0.33f, 0.60f},
    [FORCE_RED] = {0.70f, 0.24f, 0.15f},
};

int scene_init(struct draw_list *list)
{
    *list = (struct draw_list){.detail = 1.0f, .texture_budget = TERRAIN_TILES_ALL};
    list->plants = malloc(DRAW_LIST_PLANTS_MAX * sizeof *list->plants);
    list->bodies = malloc(DRAW_LIST_BODIES_MAX * sizeof *list->bodies);
    list->instances = malloc(DRAW_LIST_BODIES_MAX * sizeof *list->instances);
    list->particles = malloc(DRAW_LIST_PARTICLES_MAX * sizeof *list->particles);
    list->dents = malloc(DRAW_LIST_DENTS_MAX * sizeof *list->dents);
    list->order = malloc(DRAW_LIST_BODIES_MAX * sizeof *list->order);
    list->particle_keys = malloc(2 * DRAW_LIST_PARTICLES_MAX * sizeof *list->particle_keys);
    list->particles_sorted = malloc(DRAW_LIST_PARTICLES_MAX * sizeof *list->particles_sorted);
    list->grass = grass_new();
    if (list->plants != NULL && list->bodies != NULL && list->instances != NULL &&
        list->particles != NULL && list->dents != NULL && list->order != NULL &&
        list->particle_keys != NULL && list->particles_sorted != NULL && list->grass != NULL)
        return 0;
    scene_free(list);
    return -1;
}

void scene_free(struct draw_list *list)
{
    free(list->plants);
    free(list->bodies);
    free(list->instances);
    free(list->particles);
    free(list->dents);
    free(list->order);
    free(list->particle_keys);
    free(list->particles_sorted);
    grass_free(list->grass);
    memset(list, 0, sizeof *list);
}

/* --- vehicles and munitions ------------------------------------------------------------------- */

/* Copies the positions of turret, gun, steering, rotor and wheels into the body. */
static void set_articulation(const struct draw_list *list, const struct frame_view *frame_view,
                             uint32_t slot, struct draw_list_body *body)
{
    const struct entities *e = frame_view->entities;
    struct articulation_state state = articulation_of(frame_view->articulation, frame_view, slot);
    double turns = e->row[slot].state == ENTITY_WRECK ? 0.0 : ROTOR_HZ * list->time_s;
    body->turret_rad = state.turret_rad;
    body->gun_rad = state.gun_rad;
    body->steer_rad = state.steer_rad;
    body->rotor_rad = (float)(TWO_PI * (turns - floor(turns)) + e->row[slot].id % 7u);
    for (uint32_t side = 0; side < 2; side++)
        body->travel_m[side] = (float)state.travel_m[side];
}

static float burn_of(const struct entities *e, uint32_t slot)
{
    static const float burn[DAMAGE_COUNT] = {0.0f, BURN_LOW, BURN_MED, BURN_HIGH, 1.0f};
    if (e->row[slot].state == ENTITY_WRECK)
        return 1.0f;
    return e->row[slot].damage < DAMAGE_COUNT ? burn[e->row[slot].damage] : 1.0f;
}

/* Adds the body's dents to the draw list. */
static void add_dents(struct draw_list *list, const struct frame_view *frame_view, uint32_t id,
                      struct draw_list_body *body)
{
    struct dented of[DENT_INDEX_PER_BODY];
    uint32_t count = dent_index_of(frame_view->dents, id, frame_view->head->tick,
                                   frame_view->world->params->dt_s, of);
    if (list->dent_count + count > DRAW_LIST_DENTS_MAX) {
        list->omitted++;
        return;
    }
    body->dents[0] = (float)list->dent_count;
    body->dents[1] = (float)count;
    for (uint32_t i = 0; i < count; i++) {
        struct draw_list_dent *dent = &list->dents[list->dent_count++];
        memcpy(dent->point, of[i].point, sizeof dent->point);
        memcpy(dent->direction, of[i].direction, sizeof dent->direction);
        dent->depth_m = of[i].depth_m;
        dent->reach_m = DENT_MIN_REACH_M + DENT_REACH * of[i].depth_m;
    }
}

/* Presses a body that has broken up flat on the ground. */
static void flatten(const struct frame_view *frame_view, double radius_m, struct vec3 *position,
                    struct body_axes *axes)
{
    double ground =
        terrain_height(&frame_view->world->terrain, frame_view->craters, position->x, position->z);
    position->y -= (1.0 - BROKEN_HEIGHT) * maths_clamp(position->y - ground, 0.0, radius_m);
    axes->forward.y *= BROKEN_HEIGHT;
    axes->up.y *= BROKEN_HEIGHT;
    axes->right.y *= BROKEN_HEIGHT;
}

static void add_entity(struct draw_list *list, const struct frame_view *frame_view, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    if (e->row[slot].state == ENTITY_FREE || e->row[slot].kind >= frame_view->world->counts.kinds)
        return;
    const struct kind *kind = &frame_view->world->kinds[e->row[slot].kind];
    if (kind->model >= frame_view->world->counts.models)
        return;
    struct vec3 position = entities_position(e, slot);
    double distance = vec3_length(vec3_sub(position, list->camera.eye));
    double pixels = camera_pixels(&list->camera, 2.0 * kind->radius_m, distance);
    /* The radius is enlarged because the shadow may be in view when the body is not. */
    if (pixels < BODY_MIN_PIXELS || !camera_sees(&list->camera, position, 3.0 * kind->radius_m))
        return;
    bool bent = pixels > BENT_MIN_PIXELS && dent_index_any(frame_view->dents, e->row[slot].id);
    struct draw_list_body *body =
        draw_list_add_body(list, kind->model, draw_list_detail(pixels, bent));
    if (body == NULL)
        return;
    struct body_axes axes =
        body_axes_of(e->row[slot].heading, e->row[slot].pitch, e->row[slot].roll);
    if (e->row[slot].state == ENTITY_WRECK && e->row[slot].flags & ENTITY_FLAG_BROKEN)
        flatten(frame_view, kind->radius_m, &position, &axes);
    draw_list_place_body(list, body, position, &axes, 1.0);
    memcpy(body->tint, force_colours[e->row[slot].force % FORCE_COUNT], sizeof body->tint);
    body->burn = burn_of(e, slot);
    set_articulation(list, frame_view, slot, body);
    if (bent)
        add_dents(list, frame_view, e->row[slot].id, body);
    draw_list_add_shadow(list, frame_view, position, pixels);
}

void scene_build(struct draw_list *list, const struct camera *camera,
                 const struct static_scene *static_scene, const struct frame_view *frame_view,
                 const struct effects *effects)
{
    list->camera = *camera;
    list->frustum = frustum_of(camera);
    list->time_s = frame_view_time_s(frame_view);
    const struct renderer_params *wanted = &frame_view->world->params->renderer;
    list->fog = wanted->fog != 0;
    list->haze = wanted->haze != 0;
    list->texture = wanted->texture != 0;
    list->plant_count = list->body_count = list->particle_count = 0;
    list->dent_count = list->omitted = 0;
    list->patch_count = terrain_quadtree_select(&static_scene->ground, camera, list->patches);
    plants_add(list, static_scene, frame_view);
    for (uint32_t slot = 0; slot < frame_view->head->used; slot++)
        add_entity(list, frame_view, slot);
    fixed_objects_add(list, static_scene, frame_view);
    debris_add(list, static_scene, frame_view, effects);
    draw_list_sort_bodies(list);
    rotors_add(list, static_scene, frame_view);
    particle_emitters_add(list, frame_view, effects);
}
