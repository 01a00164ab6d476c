/* Bodies, and the order of everything. */
#include "renderer/scene/scene.h"

#include "renderer/scene/noise/value_noise.h"
#include "renderer/scene/frame/light.h"
#include "renderer/scene/frame/body_axes.h"
#include "renderer/scene/terrain/terrain_tiles.h"
#include "renderer/scene/plants/grass.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <stdlib.h>
#include <string.h>

#define SHADOW_LEAST_PIXELS 6.0
#define SHADOW_RANGE_M      2500.0
#define SHADOW_LIFT_M       0.06 /* above the ground, so that it does not sink into it */
#define ROTOR_TURNS         4.6  /* a second */
#define BURN_LOW            0.12f
#define BURN_MED            0.28f
#define BURN_HIGH           0.5f
#define DENT_LEAST_REACH_M  0.55f /* sheet metal bends over this at least around a dent ... */
#define DENT_REACH          2.2f  /* ... and over so many of its depths more */

/* A body found, before the list is put in order. */
struct body_order {
    struct scene_copy copy;
    uint32_t index;
};

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

enum mesh_detail scene_detail(double pixels, bool bent)
{
    if (bent && pixels > BENT_LEAST_PIXELS)
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

struct scene_body *scene_body_add(struct scene *scene, uint16_t model, enum mesh_detail detail)
{
    if (scene->body_count == SCENE_BODIES_MAX) {
        scene->omitted++;
        return NULL;
    }
    uint32_t i = scene->body_count++;
    scene->copies[i] = (struct scene_copy){.model = model, .detail = (uint8_t)detail};
    scene->bodies[i] = (struct scene_body){.burn = 0.0f};
    return &scene->bodies[i];
}

void scene_body_place(const struct scene *scene, struct scene_body *body, struct vec3 position,
                      const struct body_axes *pose, double scale)
{
    scene_place(scene, position, body->at);
    copy_axis(body->forward, pose->forward, scale);
    copy_axis(body->up, pose->up, scale);
    copy_axis(body->right, pose->right, scale);
}

/* The plane of the ground where the body's shadow falls, along the sun's light. */
void scene_body_shadow(struct scene *scene, const struct frame_view *moment, struct vec3 position,
                       double pixels)
{
    const struct terrain *terrain = &moment->world->terrain;
    struct scene_body *body = &scene->bodies[scene->body_count - 1];
    struct vec3 foot = position;
    if (pixels <= SHADOW_LEAST_PIXELS ||
        vec3_length(vec3_sub(position, scene->camera.eye)) >= SHADOW_RANGE_M)
        return;
    for (uint32_t i = 0; i < 3; i++) {
        double ground = terrain_height(terrain, moment->craters, foot.x, foot.z);
        double down = (position.y - ground) / SUN_Y;
        foot.x = position.x - SUN_X * down;
        foot.z = position.z - SUN_Z * down;
        foot.y = ground;
    }
    struct vec3 normal = terrain_normal(terrain, moment->craters, foot.x, foot.z);
    if (vec3_dot(normal, light_sun()) < 0.1)
        return;
    copy_axis(body->plane, normal, 1.0);
    struct vec3 relative = vec3_sub(foot, scene->camera.eye);
    body->plane[3] = (float)(vec3_dot(normal, relative) + SHADOW_LIFT_M);
    scene->copies[scene->body_count - 1].shadow = 1;
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
    struct scene_body *body = scene_body_add(scene, kind->model, scene_detail(pixels, bent));
    if (body == NULL)
        return;
    struct body_axes pose = body_axes_of(e->heading[slot], e->pitch[slot], e->roll[slot]);
    scene_body_place(scene, body, position, &pose, 1.0);
    memcpy(body->tint, force_colours[e->force[slot] % FORCE_COUNT], sizeof body->tint);
    body->burn = burn_of(e, slot);
    show_gear(scene, moment, slot, body);
    if (bent)
        add_dents(scene, moment, e->id[slot], body);
    scene_body_shadow(scene, moment, position, pixels);
}

/* --- order ------------------------------------------------------------------------------------ */

static int by_model(const void *a, const void *b)
{
    const struct body_order *x = a, *y = b;
    if (x->copy.model != y->copy.model)
        return x->copy.model < y->copy.model ? -1 : 1;
    if (x->copy.detail != y->copy.detail)
        return x->copy.detail < y->copy.detail ? -1 : 1;
    return (x->index > y->index) - (x->index < y->index);
}

static void swap_bodies(struct scene *scene, uint32_t a, uint32_t b)
{
    struct scene_body body = scene->bodies[a];
    scene->bodies[a] = scene->bodies[b];
    scene->bodies[b] = body;
    struct scene_copy copy = scene->copies[a];
    scene->copies[a] = scene->copies[b];
    scene->copies[b] = copy;
}

/* Brings copies of one mesh together, so that each mesh is drawn once. */
static void sort_bodies(struct scene *scene)
{
    uint32_t count = scene->body_count;
    for (uint32_t i = 0; i < count; i++)
        scene->order[i] = (struct body_order){scene->copies[i], i};
    qsort(scene->order, count, sizeof *scene->order, by_model);
    /* Along each cycle of the permutation, in place. */
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = i;
        while (scene->order[at].index != i) {
            uint32_t from = scene->order[at].index;
            swap_bodies(scene, at, from);
            scene->order[at].index = at;
            at = from;
        }
        scene->order[at].index = at;
    }
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
    scene_plants(scene, scenery, moment);
    for (uint32_t slot = 0; slot < moment->head->used; slot++)
        add_entity(scene, moment, slot);
    scene_fixed(scene, scenery, moment);
    scene_debris(scene, scenery, moment, effects);
    sort_bodies(scene);
    scene_rotors(scene, scenery, moment);
    scene_puffs(scene, moment, effects);
}
