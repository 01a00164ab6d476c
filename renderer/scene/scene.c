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

#define ROTOR_TURNS        4.6 /* a second */
#define BURN_LOW           0.12f
#define BURN_MED           0.28f
#define BURN_HIGH          0.5f
#define DENT_LEAST_REACH_M 0.55f /* sheet metal bends over this at least around a dent ... */
#define DENT_REACH         2.2f  /* ... and over so many of its depths more */

static const float force_colours[FORCE_COUNT][3] = {
    [FORCE_NEUTRAL] = {0.54f, 0.53f, 0.44f},
    [FORCE_BLUE] = {0.17f, 0.33f, 0.60f},
    [FORCE_RED] = {0.70f, 0.24f, 0.15f},
};

int scene_init(struct scene *scene)
{
    *scene = (struct scene){.detail = 1.0f, .paintings = TERRAIN_TILES_ALL};
    scene->plants = malloc(SCENE_PLANTS_MAX * sizeof *scene->plants);
    scene->bodies = malloc(SCENE_BODIES_MAX * sizeof *scene->bodies);
    scene->copies = malloc(SCENE_BODIES_MAX * sizeof *scene->copies);
    scene->puffs = malloc(SCENE_PUFFS_MAX * sizeof *scene->puffs);
    scene->dents = malloc(SCENE_DENTS_MAX * sizeof *scene->dents);
    scene->order = malloc(SCENE_BODIES_MAX * sizeof *scene->order);
    scene->puff_keys = malloc(2 * SCENE_PUFFS_MAX * sizeof *scene->puff_keys);
    scene->puffs_sorted = malloc(SCENE_PUFFS_MAX * sizeof *scene->puffs_sorted);
    scene->tufts = grass_new();
    if (scene->plants != NULL && scene->bodies != NULL && scene->copies != NULL &&
        scene->puffs != NULL && scene->dents != NULL && scene->order != NULL &&
        scene->puff_keys != NULL && scene->puffs_sorted != NULL && scene->tufts != NULL)
        return 0;
    scene_free(scene);
    return -1;
}

void scene_free(struct scene *scene)
{
    free(scene->plants);
    free(scene->bodies);
    free(scene->copies);
    free(scene->puffs);
    free(scene->dents);
    free(scene->order);
    free(scene->puff_keys);
    free(scene->puffs_sorted);
    grass_free(scene->tufts);
    memset(scene, 0, sizeof *scene);
}

/* --- vehicles and munitions ------------------------------------------------------------------- */

/* Where its turret points, how far it has come. */
static void show_gear(const struct scene *scene, const struct frame_view *moment, uint32_t slot,
                      struct scene_body *body)
{
    const struct entities *e = moment->entities;
    struct articulation_state state = articulation_of(moment->gear, moment, slot);
    double turns = e->state[slot] == ENTITY_WRECK ? 0.0 : ROTOR_TURNS * scene->time_s;
    body->turret_rad = state.turret_rad;
    body->gun_rad = state.gun_rad;
    body->steer_rad = state.steer_rad;
    body->rotor_rad = (float)(TWO_PI * (turns - floor(turns)) + e->id[slot] % 7u);
    for (uint32_t side = 0; side < 2; side++)
        body->way_m[side] = (float)state.way_m[side];
}

static float burn_of(const struct entities *e, uint32_t slot)
{
    static const float burn[DAMAGE_COUNT] = {0.0f, BURN_LOW, BURN_MED, BURN_HIGH, 1.0f};
    if (e->state[slot] == ENTITY_WRECK)
        return 1.0f;
    return e->damage[slot] < DAMAGE_COUNT ? burn[e->damage[slot]] : 1.0f;
}

/* The body's dents into the scene's list. */
static void add_dents(struct scene *scene, const struct frame_view *moment, uint32_t id,
                      struct scene_body *body)
{
    struct dented of[DENT_INDEX_PER_BODY];
    uint32_t count =
        dent_index_of(moment->dents, id, moment->head->tick, moment->world->params->dt_s, of);
    if (scene->dent_count + count > SCENE_DENTS_MAX) {
        scene->omitted++;
        return;
    }
    body->dents[0] = (float)scene->dent_count;
    body->dents[1] = (float)count;
    for (uint32_t i = 0; i < count; i++) {
        struct scene_dent *dent = &scene->dents[scene->dent_count++];
        memcpy(dent->point, of[i].point, sizeof dent->point);
        memcpy(dent->way, of[i].direction, sizeof dent->way);
        dent->depth_m = of[i].depth_m;
        dent->reach_m = DENT_LEAST_REACH_M + DENT_REACH * of[i].depth_m;
    }
}

static void add_entity(struct scene *scene, const struct frame_view *moment, uint32_t slot)
{
    const struct entities *e = moment->entities;
    if (e->state[slot] == ENTITY_FREE || e->kind[slot] >= moment->world->counts.kinds)
        return;
    const struct kind *kind = &moment->world->kinds[e->kind[slot]];
    if (kind->model >= moment->world->counts.models)
        return;
    struct vec3 position = entities_position(e, slot);
    double distance = vec3_length(vec3_sub(position, scene->camera.eye));
    double pixels = camera_pixels(&scene->camera, 2.0 * kind->radius_m, distance);
    /* Its shadow may be in the picture when the body is not. */
    if (pixels < BODY_LEAST_PIXELS || !camera_sees(&scene->camera, position, 3.0 * kind->radius_m))
        return;
    bool bent = pixels > BENT_LEAST_PIXELS && dent_index_any(moment->dents, e->id[slot]);
    struct scene_body *body =
        draw_list_add_body(scene, kind->model, draw_list_detail(pixels, bent));
    if (body == NULL)
        return;
    struct body_axes axes = body_axes_of(e->heading[slot], e->pitch[slot], e->roll[slot]);
    draw_list_place_body(scene, body, position, &axes, 1.0);
    memcpy(body->tint, force_colours[e->force[slot] % FORCE_COUNT], sizeof body->tint);
    body->burn = burn_of(e, slot);
    show_gear(scene, moment, slot, body);
    if (bent)
        add_dents(scene, moment, e->id[slot], body);
    draw_list_add_shadow(scene, moment, position, pixels);
}

void scene_build(struct scene *scene, const struct camera *camera,
                 const struct static_scene *scenery, const struct frame_view *moment,
                 const struct effects *effects)
{
    scene->camera = *camera;
    scene->sight = frustum_of(camera);
    scene->time_s = frame_view_time_s(moment);
    const struct renderer_params *wanted = &moment->world->params->renderer;
    scene->fog = wanted->fog != 0;
    scene->haze = wanted->haze != 0;
    scene->texture = wanted->texture != 0;
    scene->plant_count = scene->body_count = scene->puff_count = 0;
    scene->dent_count = scene->omitted = 0;
    scene->patch_count = terrain_quadtree_select(&scenery->ground, camera, scene->patches);
    plants_add(scene, scenery, moment);
    for (uint32_t slot = 0; slot < moment->head->used; slot++)
        add_entity(scene, moment, slot);
    fixed_objects_add(scene, scenery, moment);
    debris_add(scene, scenery, moment, effects);
    draw_list_sort_bodies(scene);
    rotors_add(scene, scenery, moment);
    particle_emitters_add(scene, moment, effects);
}
