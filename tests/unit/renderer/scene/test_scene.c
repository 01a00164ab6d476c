/* The scene: cameras, culling, levels of detail, the draw list, tracks and statistics (thesis rows
 * 5, 12, 13 and 33). Nothing here is drawn. */
#include "renderer/scene/scene.h"

#include "renderer/scene/frame/body_axes.h"
#include "renderer/scene/frame/statistics.h"
#include "renderer/chart/track.h"
#include "tests/support/scene_stage.h"
#include "world/entity/event.h"
#include "world/enum_names.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/terrain/fallen.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SEED     7u
#define CAPACITY 16u

enum { TANK, TREE, HOUSE, POLE, TOWER, SHRUB, KINDS };
enum { BUSH, TANKS, MAST, OAK, COTTAGE, FIXED }; /* in gridsquare order */

static const struct kind kinds[KINDS] = {
    [TANK] = {.name = "tank",
              .domain = DOMAIN_LAND,
              .radius_m = 4.0,
              .length_m = 7.0,
              .width_m = 3.6,
              .height_m = 2.4,
              .fuel_l = 1000.0},
    [TREE] = {.name = "oak",
              .domain = DOMAIN_FIXED,
              .object_class = OBJECT_TREE,
              .radius_m = 2.0,
              .height_m = 10.0},
    [HOUSE] = {.name = "house",
               .domain = DOMAIN_FIXED,
               .object_class = OBJECT_BUILDING,
               .radius_m = 6.0,
               .width_m = 8.0,
               .height_m = 5.0},
    [POLE] = {.name = "pole",
              .domain = DOMAIN_FIXED,
              .object_class = OBJECT_POLE,
              .radius_m = 0.4,
              .width_m = 0.4,
              .height_m = 8.0},
    [TOWER] = {.name = "tower",
               .domain = DOMAIN_FIXED,
               .object_class = OBJECT_WATERTOWER,
               .radius_m = 4.0,
               .width_m = 6.0,
               .height_m = 20.0},
    [SHRUB] = {.name = "shrub",
               .domain = DOMAIN_FIXED,
               .object_class = OBJECT_BUSH,
               .radius_m = 1.0,
               .height_m = 1.5},
};

static const struct model_vertex box_vertices[] = {{-3, 0, -1}, {3, 0, -1}, {3, 2, -1}, {-3, 2, -1},
                                                   {-3, 0, 1},  {3, 0, 1},  {3, 2, 1},  {-3, 2, 1}};

static const struct model_triangle box_triangles[] = {
    {.vertex = {0, 3, 2}},
    {.vertex = {0, 2, 1}},
    {.vertex = {4, 5, 6}},
    {.vertex = {4, 6, 7}},
    {.vertex = {3, 7, 6}, .part = PART_TURRET},
    {.vertex = {3, 6, 2}, .part = PART_TURRET},
};

static const struct model models[] = {
    {.name = "box", .triangle_count = 6, .vertex_count = 8},
};

static const struct fixed_object objects[FIXED] = {
    [OAK] = {.x = 25060.0, .z = 24900.0, .radius_m = 2.0f, .height_m = 10.0f, .kind = TREE},
    [COTTAGE] = {.x = 25000.0, .z = 24940.0, .radius_m = 6.0f, .height_m = 5.0f, .kind = HOUSE},
    [MAST] = {.x = 24900.0, .z = 24900.0, .radius_m = 0.6f, .height_m = 12.0f, .kind = POLE},
    [TANKS] = {.x = 24800.0, .z = 24900.0, .radius_m = 4.0f, .height_m = 20.0f, .kind = TOWER},
    [BUSH] = {.x = 24700.0, .z = 24900.0, .radius_m = 1.0f, .height_m = 1.5f, .kind = SHRUB},
};

static double draw(uint64_t number, double low, double high)
{
    return random_between(SEED, number, 0, RANDOM_NOISE, low, high);
}

static void build_ground(struct scene_stage *s)
{
    for (uint32_t row = 0; row < SCENE_STAGE_POSTS; row++)
        for (uint32_t column = 0; column < SCENE_STAGE_POSTS; column++)
            s->posts[row * SCENE_STAGE_POSTS + column] =
                (float)(300.0 + 200.0 * sin(column * 0.11) * cos(row * 0.07) +
                        25.0 * sin(column * 0.9 + row));
}

static int open_stage(void **context)
{
    struct scene_stage *s = scene_stage_new(CAPACITY, FIXED);
    s->params.hz = 10.0;
    s->params.dt_s = 0.1;
    s->params.renderer = (struct renderer_params){.fog = 1, .haze = 1, .texture = 1};
    build_ground(s);
    s->world.kinds = kinds;
    s->world.models = models;
    s->world.model_vertices = box_vertices;
    s->world.model_triangles = box_triangles;
    s->world.counts.kinds = KINDS;
    s->world.counts.models = 1;
    s->world.counts.model_vertices = 8;
    s->world.counts.model_triangles = 6;
    s->world.counts.fixed = FIXED;
    for (uint32_t i = 0; i < FIXED; i++) {
        s->fixed[i] = objects[i];
        s->fixed[i].y = (float)terrain_base_height(&s->world.terrain, objects[i].x, objects[i].z);
    }
    scene_stage_ready(s);
    *context = s;
    return 0;
}

/* Adds a tank on the ground at (x, z). Returns its slot. */
static uint32_t put_tank(struct scene_stage *s, double x, double z, double heading)
{
    uint32_t slot = scene_stage_put(s, TANK, x, z, heading);
    s->entities.row[slot].y = terrain_base_height(&s->world.terrain, x, z);
    return slot;
}

static struct camera look_from(const struct scene_stage *s, double x, double z, double heading)
{
    struct camera camera;
    double y = terrain_base_height(&s->world.terrain, x, z) + 20.0;
    camera_look(&camera, (struct vec3){x, y, z},
                (struct vec3){x + sin(heading) * 100.0, y - 15.0, z - cos(heading) * 100.0}, 1280,
                720);
    return camera;
}

/* --- cameras ---------------------------------------------------------------------------------- */

static void test_pose_axes(void **context)
{
    (void)context;
    struct body_axes east = body_axes_of(HALF_PI, 0.0, 0.0);
    assert_true(fabs(east.forward.x - 1.0) < 1e-12 && fabs(east.right.z - 1.0) < 1e-12);
    struct body_axes climbing = body_axes_of(0.0, 0.3, 0.0);
    assert_true(climbing.forward.y > 0.29 && climbing.forward.z < -0.95);
    struct body_axes rolled = body_axes_of(0.0, 0.0, 0.3);
    assert_true(rolled.right.y < -0.29); /* right side down */
    struct body_axes any = body_axes_of(1.0, 0.4, -0.7);
    assert_true(fabs(vec3_dot(any.forward, any.up)) < 1e-12);
    assert_true(fabs(vec3_dot(any.up, any.right)) < 1e-12);
}

static void test_no_body_in_view_is_culled(void **context)
{
    struct scene_stage *s = *context;
    uint32_t inside = 0, culled = 0;
    for (uint64_t i = 0; i < 20000; i++) {
        struct camera camera = look_from(s, 25000.0, 25000.0, draw(5 * i, 0.0, TWO_PI));
        struct vec3 place = {draw(5 * i + 1, 20000.0, 30000.0), draw(5 * i + 2, 0.0, 2000.0),
                             draw(5 * i + 3, 20000.0, 30000.0)};
        bool sees = camera_sees(&camera, place, 0.01);
        struct vec3 margin = {0.01, 0.01, 0.01};
        bool sees_box = camera_sees_box(&camera, vec3_sub(place, margin), vec3_add(place, margin));
        if (scene_stage_in_picture(&camera, place)) {
            inside++;
            assert_true(sees);
            assert_true(sees_box);
        } else {
            culled += !sees;
        }
    }
    assert_true(inside > 500);
    assert_true(culled > 15000);
}

/* --- ground ----------------------------------------------------------------------------------- */

static bool patch_holds(const struct terrain_quadtree_patch *patch, double x, double z)
{
    double side = terrain_quadtree_patch_side(patch->level);
    return x >= patch->column * side && x < (patch->column + 1) * side && z >= patch->row * side &&
           z < (patch->row + 1) * side;
}

static void test_ground_is_covered_once(void **context)
{
    struct scene_stage *s = *context;
    static struct terrain_quadtree_patch patches[TERRAIN_QUADTREE_PATCHES_MAX];
    uint32_t seen = 0;
    for (uint64_t i = 0; i < 20; i++) {
        struct camera camera =
            look_from(s, draw(2 * i, 500.0, 49500.0), draw(2 * i + 1, 500.0, 49500.0), (double)i);
        uint32_t count = terrain_quadtree_select(&s->static_scene.ground, &camera, patches);
        assert_true(count > 0 && count < TERRAIN_QUADTREE_PATCHES_MAX);
        for (uint64_t j = 0; j < 500; j++) {
            double reach = pow(10.0, draw(1000 * i + 2 * j, 1.0, 4.5));
            double turn = draw(1000 * i + 2 * j + 1, 0.0, TWO_PI);
            double x = camera.eye.x + reach * sin(turn), z = camera.eye.z + reach * cos(turn);
            struct vec3 on = {x, terrain_base_height(&s->world.terrain, x, z), z};
            uint32_t holders = 0;
            for (uint32_t k = 0; k < count; k++)
                holders += patch_holds(&patches[k], x, z);
            assert_true(holders <= 1);
            if (scene_stage_in_picture(&camera, on)) {
                assert_int_equal(holders, 1);
                seen++;
            }
        }
    }
    assert_true(seen > 500);
}

static void test_ground_detail_falls_with_distance(void **context)
{
    struct scene_stage *s = *context;
    static struct terrain_quadtree_patch patches[TERRAIN_QUADTREE_PATCHES_MAX];
    struct camera camera = look_from(s, 24000.0, 26000.0, 0.7);
    uint32_t count = terrain_quadtree_select(&s->static_scene.ground, &camera, patches);
    for (uint32_t i = 0; i < count; i++) {
        double side = terrain_quadtree_patch_side(patches[i].level);
        assert_true(patches[i].level == TERRAIN_QUADTREE_LEVEL_MAX ||
                    patches[i].distance_m >= TERRAIN_QUADTREE_SPLIT * side);
        if (i > 0)
            assert_true(patches[i].distance_m >= patches[i - 1].distance_m);
    }
    assert_int_equal(patches[0].level, TERRAIN_QUADTREE_LEVEL_MAX);
    assert_true(patches[count - 1].level < 5);
}

/* --- scenes ----------------------------------------------------------------------------------- */

static void test_body_detail_is_monotone(void **context)
{
    (void)context;
    enum mesh_detail before = MESH_COARSEST;
    for (double pixels = 0.5; pixels < 500.0; pixels *= 1.1) {
        enum mesh_detail now = draw_list_detail(pixels, false);
        assert_true(now <= before); /* the finer level or the same for the larger body */
        assert_true(draw_list_detail(pixels, true) <= now);
        before = now;
    }
    assert_int_equal(before, MESH_FULL);
}

static void test_bodies_in_view_are_listed(void **context)
{
    struct scene_stage *s = *context;
    uint32_t ahead = put_tank(s, 25000.0, 24960.0, 0.4);
    put_tank(s, 25000.0, 25090.0, 0.0); /* behind */
    struct camera camera = look_from(s, 25000.0, 25000.0, 0.0);
    scene_build(&s->list, &camera, &s->static_scene, &s->frame_view, &s->effects);
    assert_int_equal(s->list.omitted, 0);
    uint32_t tanks = 0;
    for (uint32_t i = 0; i < s->list.body_count; i++) {
        const struct draw_list_body *body = &s->list.bodies[i];
        if (fabs((double)body->at[2] + 40.0) < 1e-3 && fabs((double)body->at[0]) < 1e-3) {
            tanks++;
            assert_true(fabs((double)body->forward[0] - sin(s->entities.row[ahead].heading)) <
                        1e-6);
        }
        assert_true(body->at[2] < 20.0f); /* nothing behind the camera */
    }
    assert_int_equal(tanks, 1);
}

static void test_damage_is_visible_in_steps(void **context)
{
    struct scene_stage *s = *context;
    uint32_t slot = put_tank(s, 25010.0, 24940.0, 0.0);
    struct camera camera = look_from(s, 25010.0, 25000.0, 0.0);
    float before = -1.0f;
    uint32_t smoke = 0;
    for (uint32_t damage = DAMAGE_NONE; damage < DAMAGE_COUNT; damage++) {
        s->entities.row[slot].damage = (uint8_t)damage;
        s->entities.row[slot].state = damage == DAMAGE_DESTROYED ? ENTITY_WRECK : ENTITY_ACTIVE;
        s->head.tick = 500;
        s->entities.row[slot].changed_tick = 300;
        scene_build(&s->list, &camera, &s->static_scene, &s->frame_view, &s->effects);
        uint32_t at = 0;
        while (at < s->list.body_count && fabs((double)s->list.bodies[at].at[0]) > 1e-3)
            at++;
        assert_true(at < s->list.body_count);
        const struct draw_list_body *body = &s->list.bodies[at];
        assert_true(body->burn > before); /* each level looks worse than the one before */
        before = body->burn;
        smoke = s->list.particle_count;
    }
    assert_true(smoke > 10); /* a wreck burns */
}

/* --- dents (row 33) --------------------------------------------------------------------------- */

static void dent(struct scene_stage *s, uint32_t id, float plastic_m)
{
    s->dent[s->head.dent_count++] = (struct dent){.id = id,
                                                  .point = {3.0f, 1.0f, 0.0f},
                                                  .direction = {-1.0f, 0.0f, 0.0f},
                                                  .plastic_m = plastic_m};
    dent_index_update(&s->dents, s->head.dent_count);
}

static void test_a_wreck_that_has_broken_up_is_flat(void **context)
{
    struct scene_stage *s = *context;
    uint32_t slot = put_tank(s, 25010.0, 24940.0, 0.0);
    struct camera camera = look_from(s, 25010.0, 25000.0, 0.0);
    s->entities.row[slot].state = ENTITY_WRECK;
    s->entities.row[slot].pitch = 0.5;
    s->entities.row[slot].flags = ENTITY_FLAG_BROKEN;
    scene_build(&s->list, &camera, &s->static_scene, &s->frame_view, &s->effects);
    uint32_t at = 0;
    while (at < s->list.body_count && fabs((double)s->list.bodies[at].at[0]) > 1e-3)
        at++;
    assert_true(at < s->list.body_count);
    const struct draw_list_body *body = &s->list.bodies[at];
    assert_true(body->up[1] < 0.5f && fabs((double)body->forward[1]) < 0.5 * sin(0.5));
    double level = hypot((double)body->forward[0], (double)body->forward[2]);
    assert_true(fabs(level - cos(0.5)) < 1e-6);
}

static void test_a_near_body_is_drawn_with_its_dents(void **context)
{
    struct scene_stage *s = *context;
    uint32_t bent = put_tank(s, 25010.0, 24985.0, 0.0);
    uint32_t far = put_tank(s, 25010.0, 24300.0, 0.0);
    dent(s, s->entities.row[bent].id, 0.2f);
    dent(s, s->entities.row[bent].id, 0.1f);
    dent(s, s->entities.row[far].id, 0.3f);
    struct camera camera = look_from(s, 25010.0, 25000.0, 0.0);
    scene_build(&s->list, &camera, &s->static_scene, &s->frame_view, &s->effects);
    assert_int_equal(s->list.dent_count, 2); /* the dents of the far body are too small */
    assert_true(s->list.dents[0].depth_m == 0.2f && s->list.dents[1].depth_m == 0.1f);
    assert_true(s->list.dents[0].reach_m > s->list.dents[1].reach_m);
    assert_true(s->list.dents[0].direction[0] == -1.0f && s->list.dents[0].point[0] == 3.0f);
    uint32_t with = 0;
    for (uint32_t i = 0; i < s->list.body_count; i++) {
        if (s->list.bodies[i].dents[1] <= 0.0f)
            continue;
        with++;
        assert_true(s->list.bodies[i].dents[0] == 0.0f && s->list.bodies[i].dents[1] == 2.0f);
        assert_int_equal(s->list.instances[i].detail, MESH_FINE);
    }
    assert_int_equal(with, 1);
}

/* --- what is left of fixed objects (rows 27, 32, 33) ------------------------------------------ */

static void look_at(struct scene_stage *s, uint32_t object)
{
    const struct fixed_object *at = &s->fixed[object];
    struct vec3 middle = {at->x, (double)at->y + 0.5 * (double)at->height_m, at->z};
    struct camera camera;
    camera_look(&camera, vec3_add(middle, (struct vec3){3.0, 5.0, 30.0}), middle, 960, 540);
    s->params.renderer.texture = 0; /* without grass, whose clumps are plants too */
    scene_build(&s->list, &camera, &s->static_scene, &s->frame_view, &s->effects);
}

/* Returns the body at the object's position. */
static const struct draw_list_body *body_of(const struct scene_stage *s, uint32_t object)
{
    for (uint32_t i = 0; i < s->list.body_count; i++) {
        const struct draw_list_body *body = &s->list.bodies[i];
        double x = (double)body->at[0] + s->list.camera.eye.x - objects[object].x;
        double z = (double)body->at[2] + s->list.camera.eye.z - objects[object].z;
        if (fabs(x) < 1e-2 && fabs(z) < 1e-2)
            return body;
    }
    fail_msg("object %u is not in the scene", object);
    return NULL;
}

static void test_a_tree_leans_and_then_is_a_stump(void **context)
{
    struct scene_stage *s = *context;
    for (uint32_t damage = DAMAGE_NONE; damage <= DAMAGE_DESTROYED; damage++) {
        s->fixed_damage[OAK] = (uint8_t)damage;
        look_at(s, OAK);
        uint32_t stumps = 0;
        for (uint32_t i = 0; i < s->list.plant_count; i++)
            stumps += (enum plant_impostors)s->list.plants[i].picture == PLANT_IMPOSTORS_STUMP;
        bool down = damage >= DAMAGE_HIGH; /* a stump, and the tree beside it */
        assert_int_equal(s->list.plant_count, 1);
        assert_int_equal(stumps, down ? 1 : 0);
        assert_true((fabsf(s->list.plants[0].lean) > 0.2f) == (damage == DAMAGE_MED));
        uint32_t lying = 0;
        for (uint32_t i = 0; i < s->list.body_count; i++)
            lying += fabsf(s->list.bodies[i].up[1]) < 0.7f;
        assert_int_equal(lying, damage == DAMAGE_HIGH ? 1 : 0); /* later it is scattered */
        assert_true((s->list.plants[0].height < 5.0f) == down);
    }
}

/* Returns the body that lies. */
static const struct draw_list_body *lying_body(struct scene_stage *s)
{
    const struct draw_list_body *found = NULL;
    look_at(s, OAK);
    for (uint32_t i = 0; i < s->list.body_count; i++) {
        if (fabsf(s->list.bodies[i].up[1]) < 0.7f)
            found = &s->list.bodies[i];
    }
    assert_non_null(found);
    return found;
}

static void test_a_felled_tree_lies_as_it_fell_and_where_it_was_pushed(void **context)
{
    struct scene_stage *s = *context;
    s->fixed_damage[OAK] = FALLEN_FIRST + FALLEN_STEPS / 4; /* east */
    const struct draw_list_body *body = lying_body(s);
    double x = (double)body->at[0] + s->list.camera.eye.x - objects[OAK].x;
    assert_true(body->up[0] > 0.9f && fabsf(body->up[2]) < 0.1f);
    assert_true(x > 0.3 && x < 1.0);
    s->head.debris_count = 1;
    s->head.debris[0] = (struct debris){.object = OAK,
                                        .x = objects[OAK].x + 5.0,
                                        .z = objects[OAK].z + 20.0,
                                        .heading_rad = (float)PI,
                                        .half_length_m = 5.0f,
                                        .mass_kg = 1.0f};
    s->head.tick = 100000;
    body = lying_body(s);
    double z = (double)body->at[2] + s->list.camera.eye.z - objects[OAK].z;
    assert_true(body->up[2] > 0.9f && fabsf(body->up[0]) < 0.1f);
    assert_true(z > 15.3 && z < 16.0);
    s->head.debris[0].fell_tick = 100000; /* it has only begun to fall */
    look_at(s, OAK);
    for (uint32_t i = 0; i < s->list.body_count; i++)
        assert_true(s->list.bodies[i].up[1] > 0.7f);
    s->head.debris_count = 0;
    s->head.tick = 0;
}

static void test_a_heap_of_rubble_is_where_it_was_pushed(void **context)
{
    struct scene_stage *s = *context;
    look_at(s, OAK);
    uint32_t before = s->list.body_count;
    s->head.debris_count = 1;
    s->head.debris[0] = (struct debris){.object = COTTAGE,
                                        .x = objects[OAK].x + 3.0,
                                        .z = objects[OAK].z,
                                        .radius_m = 1.0f,
                                        .mass_kg = 1.0f};
    look_at(s, OAK);
    assert_int_equal(s->list.body_count, before + 1);
    assert_true(s->list.bodies[before].collapse[2] > 0.0f);
    s->head.debris_count = 0;
}

static void test_a_bush_ends_low(void **context)
{
    struct scene_stage *s = *context;
    float before = 2.0f;
    for (uint32_t damage = DAMAGE_LOW; damage <= DAMAGE_HIGH; damage++) {
        s->fixed_damage[BUSH] = (uint8_t)damage;
        look_at(s, BUSH);
        assert_int_equal(s->list.plant_count, 1);
        assert_true(s->list.plants[0].height < before);
        assert_true((enum plant_impostors)s->list.plants[0].picture != PLANT_IMPOSTORS_STUMP);
        before = s->list.plants[0].height;
    }
    assert_true(before < 0.6f);
}

static void test_a_pole_leans_and_then_is_broken(void **context)
{
    struct scene_stage *s = *context;
    float upright = 2.0f;
    for (uint32_t damage = DAMAGE_NONE; damage <= DAMAGE_DESTROYED; damage++) {
        s->fixed_damage[MAST] = (uint8_t)damage;
        look_at(s, MAST);
        const struct draw_list_body *body = body_of(s, MAST);
        if (damage >= DAMAGE_HIGH) {
            /* The top hangs down to the ground, so the part above the break has the right
             * length. */
            assert_true(body->broken[1] > 1.0f && body->broken[1] < 4.0f);
            double top = (double)body->broken[1] +
                         (8.0 - (double)body->broken[1]) * cos((double)body->broken[2]);
            assert_true(fabs(top) < 0.1 && body->up[1] > 1.49f);
            continue;
        }
        assert_true(body->broken[2] == 0.0f && body->up[1] < upright); /* 1.5 times the model */
        upright = body->up[1];
    }
    assert_true(upright < 1.48f);
}

static void test_a_tower_sags_and_then_lies(void **context)
{
    struct scene_stage *s = *context;
    float bent = -1.0f;
    for (uint32_t damage = DAMAGE_NONE; damage <= DAMAGE_HIGH; damage++) {
        s->fixed_damage[TANKS] = (uint8_t)damage;
        look_at(s, TANKS);
        const struct draw_list_body *body = body_of(s, TANKS);
        assert_true(body->broken[2] > bent);
        bent = body->broken[2];
        assert_true(damage == DAMAGE_NONE || (damage == DAMAGE_HIGH) == (body->broken[1] == 0.0f));
    }
    assert_true(fabs((double)bent - HALF_PI) < 1e-6);
}

/* Returns the share of the model's box that has collapsed, without the ragged edge. */
static double fallen(const struct draw_list_body *body)
{
    uint32_t down = 0;
    for (int x = -10; x <= 10; x++)
        for (int z = -10; z <= 10; z++)
            down += 0.3f * (float)x * body->collapse[0] + 0.1f * (float)z * body->collapse[1] +
                        body->collapse[2] >
                    1.0f;
    return down / 441.0;
}

static void test_a_building_collapses_in_steps(void **context)
{
    struct scene_stage *s = *context;
    double share[DAMAGE_COUNT];
    for (uint32_t damage = DAMAGE_NONE; damage < DAMAGE_COUNT; damage++) {
        s->fixed_damage[COTTAGE] = (uint8_t)damage;
        look_at(s, COTTAGE);
        const struct draw_list_body *body = body_of(s, COTTAGE);
        share[damage] = fallen(body);
        assert_true((body->collapse[2] > 0.0f) == (damage != DAMAGE_NONE));
        assert_true(body->up[1] == 1.0f && body->broken[2] == 0.0f);
    }
    assert_true(share[DAMAGE_NONE] == 0.0 && share[DAMAGE_LOW] > 0.0 && share[DAMAGE_LOW] < 0.4);
    assert_true(share[DAMAGE_MED] > share[DAMAGE_LOW] + 0.1 && share[DAMAGE_MED] < 0.8);
    assert_true(share[DAMAGE_HIGH] == 1.0 && share[DAMAGE_DESTROYED] == 1.0);
}

static void test_fire_and_detonation_are_visible(void **context)
{
    struct scene_stage *s = *context;
    struct camera camera = look_from(s, 25000.0, 25000.0, 0.0);
    s->head.frame = s->head.tick = 100;
    struct event events[2] = {
        {.frame = 99,
         .tick = 99,
         .type = EVENT_FIRE,
         .fire = {.shooter = {.id = 7}, .point = {25000.0, camera.eye.y - 5, 24970.0}}},
        {.frame = 95,
         .tick = 95,
         .type = EVENT_DETONATION,
         .detonation = {.point = {25000.0, camera.eye.y - 5, 24950.0}, .explosive_kg = 8.0f}},
    };
    scene_build(&s->list, &camera, &s->static_scene, &s->frame_view, &s->effects);
    uint32_t quiet = s->list.particle_count;
    effects_take(&s->effects, &s->frame_view, events, 2);
    assert_int_equal(s->effects.count, 2);
    scene_build(&s->list, &camera, &s->static_scene, &s->frame_view, &s->effects);
    assert_true(s->list.particle_count > quiet + 20);
    for (uint32_t i = 1; i < s->list.particle_count; i++) { /* farthest first */
        const float *a = s->list.particles[i - 1].at, *b = s->list.particles[i].at;
        assert_true(a[0] * a[0] + a[1] * a[1] + a[2] * a[2] >=
                    b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    }
    s->head.tick = s->head.frame = 100 + 10 * (uint64_t)(EFFECT_LIFE_S + 1.0);
    scene_build(&s->list, &camera, &s->static_scene, &s->frame_view, &s->effects);
    assert_int_equal(s->list.particle_count, quiet);
}

/* --- tracks, statistics --------------------------------------------------------------- */

static void test_statistics_equal_the_table(void **context)
{
    struct scene_stage *s = *context;
    uint32_t slot = put_tank(s, 30000.0, 20000.0, HALF_PI);
    const struct entities *e = &s->entities;
    e->row[slot].vx = 12.5;
    e->row[slot].pitch = 0.1;
    e->row[slot].roll = -0.05;
    e->row[slot].rounds = 37;
    e->row[slot].fuel_l = 820.0;
    e->row[slot].damage = DAMAGE_MED;
    e->row[slot].behaviour = BEHAVIOUR_PATROL;
    s->head.frame = 123;
    struct statistics is;
    statistics_of(&is, &s->frame_view, slot);
    assert_true(fabs(is.speed_kmh - 45.0) < 1e-9);
    assert_true(fabs(is.heading_deg - 90.0) < 1e-9);
    assert_true(fabs(is.pitch_deg - 0.1 * DEG_PER_RAD) < 1e-9);
    assert_true(fabs(is.roll_deg + 0.05 * DEG_PER_RAD) < 1e-9);
    assert_true(fabs(is.fuel_share - 0.82) < 1e-12);
    assert_true(fabs(is.altitude_m - e->row[slot].y) < 1e-12);
    assert_int_equal(is.rounds, 37);
    assert_string_equal(is.damage, damage_name(DAMAGE_MED));
    assert_string_equal(is.behaviour, behaviour_name(BEHAVIOUR_PATROL));
    char line[512];
    statistics_line(&is, line, sizeof line);
    assert_non_null(strstr(line, "frame=123 "));
    assert_non_null(strstr(line, "speed_kmh=45.00 "));
    assert_non_null(strstr(line, "rounds=37 "));
}

static void test_tracks_remember_positions(void **context)
{
    struct scene_stage *s = *context;
    struct tracks tracks;
    uint32_t slot = put_tank(s, 1000.0, 2000.0, 0.0);
    assert_int_equal(tracks_init(&tracks, CAPACITY), 0);
    for (uint32_t i = 0; i < 2 * TRACK_POINTS; i++) {
        s->entities.row[slot].x = 1000.0 + i;
        s->head.tick = i * (uint64_t)(10.0 * TRACK_INTERVAL_S + 1.0);
        tracks_note(&tracks, &s->frame_view);
        tracks_note(&tracks, &s->frame_view); /* too early */
    }
    const struct track *track = tracks_of(&tracks, slot, slot + 1);
    assert_non_null(track);
    assert_int_equal(track->count, 2 * TRACK_POINTS);
    assert_true(
        fabs((double)track->x[(track->count - 1) % TRACK_POINTS] - s->entities.row[slot].x) < 1e-3);
    assert_null(tracks_of(&tracks, slot, 99)); /* another entity in the slot has none */
    tracks_free(&tracks);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_stage, scene_stage_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_pose_axes),
        TEST(test_no_body_in_view_is_culled),
        TEST(test_ground_is_covered_once),
        TEST(test_ground_detail_falls_with_distance),
        TEST(test_body_detail_is_monotone),
        TEST(test_bodies_in_view_are_listed),
        TEST(test_damage_is_visible_in_steps),
        TEST(test_a_wreck_that_has_broken_up_is_flat),
        TEST(test_a_near_body_is_drawn_with_its_dents),
        TEST(test_a_tree_leans_and_then_is_a_stump),
        TEST(test_a_felled_tree_lies_as_it_fell_and_where_it_was_pushed),
        TEST(test_a_heap_of_rubble_is_where_it_was_pushed),
        TEST(test_a_bush_ends_low),
        TEST(test_a_pole_leans_and_then_is_broken),
        TEST(test_a_tower_sags_and_then_lies),
        TEST(test_a_building_collapses_in_steps),
        TEST(test_fire_and_detonation_are_visible),
        TEST(test_statistics_equal_the_table),
        TEST(test_tracks_remember_positions),
    };
    return cmocka_run_group_tests_name("scene", tests, NULL, NULL);
}
