/* Effects: what each event shows and for how long, which of them are kept, and that pictures do not
 * flicker: the same frame gives the same lists, and nothing appears or vanishes suddenly. */
#include "renderer/scene/frame/effects.h"

#include "renderer/scene/scene.h"
#include "renderer/scene/plants/grass.h"
#include "tests/support/fixture.h"
#include "tests/support/scene_stage.h"
#include "world/params.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CAPACITY 512u
#define HZ       60.0
#define MIDDLE   25000.0 /* [m] position of the events */
#define GROUND   100.0f  /* [m] */

enum { TANK, CHOPPER, SHIP, SHELL, MISSILE, KINDS };

static const struct kind kinds[KINDS] = {
    [TANK] = {.domain = DOMAIN_LAND,
              .radius_m = 3.0,
              .length_m = 7.0,
              .width_m = 3.6,
              .height_m = 2.4,
              .explosive_kg = 10.0},
    [CHOPPER] =
        {.domain = DOMAIN_AIR, .radius_m = 6.0, .length_m = 14.0, .width_m = 3.0, .height_m = 4.0},
    [SHIP] =
        {.domain = DOMAIN_SEA, .radius_m = 20.0, .length_m = 40.0, .width_m = 8.0, .height_m = 8.0},
    [SHELL] = {.domain = DOMAIN_MUNITION,
               .radius_m = 0.1,
               .length_m = 0.8,
               .mass_kg = 8.0,
               .max_speed_mps = 1500.0,
               .explosive_kg = 1.5},
    [MISSILE] = {.domain = DOMAIN_MUNITION,
                 .guidance = GUIDANCE_HOMING,
                 .radius_m = 0.2,
                 .length_m = 3.0,
                 .mass_kg = 45.0,
                 .max_speed_mps = 380.0,
                 .explosive_kg = 8.0},
};

static const struct model_vertex box_vertices[] = {{-3, 0, -1}, {3, 0, -1}, {3, 2, -1}, {-3, 2, -1},
                                                   {-3, 0, 1},  {3, 0, 1},  {3, 2, 1},  {-3, 2, 1}};

static const struct model_triangle box_triangles[] = {
    {.vertex = {0, 3, 2}}, {.vertex = {0, 2, 1}}, {.vertex = {4, 5, 6}},
    {.vertex = {4, 6, 7}}, {.vertex = {3, 7, 6}}, {.vertex = {3, 6, 2}},
};

static const struct model models[] = {{.name = "box", .triangle_count = 6, .vertex_count = 8}};

/* Level ground of one cover. */
static void lay(struct scene_stage *s, enum cover cover)
{
    for (uint32_t i = 0; i < SCENE_STAGE_POSTS * SCENE_STAGE_POSTS; i++) {
        s->posts[i] = GROUND;
        s->cover[i] = (uint8_t)cover;
    }
}

static int open_stage(void **context)
{
    struct scene_stage *s = scene_stage_new(CAPACITY, 1);
    s->params.hz = HZ;
    s->params.dt_s = 1.0 / HZ;
    s->params.renderer = (struct renderer_params){.fog = 1, .haze = 1};
    lay(s, COVER_SAND);
    s->world.kinds = kinds;
    s->world.models = models;
    s->world.model_vertices = box_vertices;
    s->world.model_triangles = box_triangles;
    s->world.counts.kinds = KINDS;
    s->world.counts.models = 1;
    s->world.counts.model_vertices = 8;
    s->world.counts.model_triangles = 6;
    scene_stage_ready(s);
    s->head.frame = s->head.tick = 6000;
    *context = s;
    return 0;
}

/* Adds an entity above the ground at (x, z). Returns its slot. */
static uint32_t put(struct scene_stage *s, uint16_t kind, double x, double above, double z)
{
    uint32_t slot = s->head.used++;
    const struct entities *e = &s->entities;
    e->row[slot].id = slot + 1;
    e->row[slot].state = ENTITY_ACTIVE;
    e->row[slot].kind = kind;
    e->row[slot].x = x;
    e->row[slot].y = (double)GROUND + above;
    e->row[slot].z = z;
    return slot;
}

/* Looks north at the middle from this distance. */
static void look(struct scene_stage *s, double away)
{
    struct camera camera;
    struct vec3 middle = {MIDDLE, (double)GROUND + 3.0, MIDDLE};
    camera_look(&camera, vec3_add(middle, (struct vec3){0.0, 4.0 + 0.1 * away, away}), middle, 1280,
                720);
    scene_build(&s->list, &camera, &s->static_scene, &s->frame_view, &s->effects);
}

/* Advances one step of simulation time. */
static void step(struct scene_stage *s)
{
    s->head.frame++;
    s->head.tick++;
    for (uint32_t i = 0; i < s->head.used; i++) {
        s->entities.row[i].x += s->entities.row[i].vx / HZ;
        s->entities.row[i].y += s->entities.row[i].vy / HZ;
        s->entities.row[i].z += s->entities.row[i].vz / HZ;
    }
    effects_take(&s->effects, &s->frame_view, NULL, 0);
}

/* Returns the sum over particles of opacity times size in the picture. */
static double ink(const struct scene_stage *s)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < s->list.particle_count; i++) {
        const struct draw_list_particle *particle = &s->list.particles[i];
        double far = (double)frustum_dot(particle->at, particle->at);
        double length = sqrt((double)frustum_dot(particle->axis, particle->axis));
        sum += (double)particle->colour[3] * (double)particle->size *
               maths_max(length, (double)particle->size) / far;
    }
    return sum;
}

static struct event happening(const struct scene_stage *s, enum effect_type type)
{
    struct event event = {.frame = s->head.frame, .tick = s->head.tick, .index = 3};
    double point[3] = {MIDDLE, (double)GROUND + 1.0, MIDDLE};
    static const enum struck struck[EFFECT_TYPE_COUNT] = {
        [EFFECT_EXPLOSION] = STRUCK_VEHICLE, [EFFECT_BURST] = STRUCK_GROUND,
        [EFFECT_SPLASH] = STRUCK_WATER,      [EFFECT_HIT] = STRUCK_FIXED,
        [EFFECT_CRASH] = STRUCK_GROUND,
    };
    if (type == EFFECT_FLASH) {
        event.type = EVENT_FIRE;
        event.fire = (struct event_fire){.shooter = {.id = 900}, .munition = {.kind = SHELL}};
        memcpy(event.fire.point, point, sizeof point);
        return event;
    }
    event.type = EVENT_DETONATION;
    event.detonation = (struct event_detonation){.struck = struck[type]};
    event.detonation.explosive_kg = type == EFFECT_HIT || type == EFFECT_CRASH ? 0.0f : 8.0f;
    memcpy(event.detonation.point, point, sizeof point);
    return event;
}

/* --- what happens ----------------------------------------------------------------------------- */

static void test_each_event_shows_for_its_time(void **context)
{
    struct scene_stage *s = *context;
    for (uint32_t type = 0; type < EFFECT_WRECK; type++) {
        struct event event = happening(s, (enum effect_type)type);
        uint64_t began = s->head.tick;
        look(s, 40.0);
        assert_int_equal(s->list.particle_count, 0);
        effects_take(&s->effects, &s->frame_view, &event, 1);
        assert_int_equal(s->effects.count, 1);
        assert_int_equal(s->effects.effect[0].type, type);
        double life = effects_life_s((enum effect_type)type);
        s->head.tick = began + 4;
        look(s, 40.0);
        assert_true(s->list.particle_count >= 3);
        s->head.tick = began + (uint64_t)(0.6 * life * HZ);
        look(s, 40.0);
        assert_true(s->list.particle_count >= 1);
        s->head.tick = began + (uint64_t)(life * HZ) + 1;
        look(s, 40.0);
        assert_int_equal(s->list.particle_count, 0);
        s->head.tick = began - 1; /* nor before it happened */
        look(s, 40.0);
        assert_int_equal(s->list.particle_count, 0);
        s->effects.count = 0;
        s->head.tick = began;
    }
}

static void test_a_shot_out_of_the_sky_has_no_muzzle(void **context)
{
    struct scene_stage *s = *context;
    struct event event = happening(s, EFFECT_FLASH);
    event.fire.shooter.id = 0;
    effects_take(&s->effects, &s->frame_view, &event, 1);
    assert_int_equal(s->effects.count, 0);
}

static void test_a_flash_points_along_its_round(void **context)
{
    struct scene_stage *s = *context;
    uint32_t round = put(s, SHELL, MIDDLE, 1.0, MIDDLE - 30.0);
    s->entities.row[round].vz = -1500.0;
    struct event event = happening(s, EFFECT_FLASH);
    event.fire.munition.id = s->entities.row[round].id;
    effects_take(&s->effects, &s->frame_view, &event, 1);
    assert_true(s->effects.effect[0].direction[2] < -0.999f);
    /* When the round is gone: away from the shooter. */
    s->entities.row[round].state = ENTITY_FREE;
    uint32_t tank = put(s, TANK, MIDDLE - 5.0, 1.0 - 0.7 * 2.4, MIDDLE);
    event.fire.shooter.id = s->entities.row[tank].id;
    event.fire.munition.id = 900;
    effects_take(&s->effects, &s->frame_view, &event, 1);
    assert_true(s->effects.effect[1].direction[0] > 0.999f);
}

/* Soil and water rise and fall back. */
static void test_soil_and_water_fall_back(void **context)
{
    struct scene_stage *s = *context;
    static const enum effect_type thrown[] = {EFFECT_BURST, EFFECT_SPLASH};
    for (uint32_t i = 0; i < 2; i++) {
        struct event event = happening(s, thrown[i]);
        effects_take(&s->effects, &s->frame_view, &event, 1);
        double most = 0.0, last = 0.0;
        uint64_t began = s->head.tick;
        for (uint32_t tick = 1; tick < 240; tick++) {
            s->head.tick = began + tick;
            look(s, 60.0);
            double highest = 0.0;
            for (uint32_t n = 0; n < s->list.particle_count; n++)
                if (s->list.particles[n].picture == (float)PARTICLE_SPRAY)
                    highest = maths_max(highest,
                                        (double)s->list.particles[n].at[1] + s->list.camera.eye.y);
            most = maths_max(most, highest);
            last = highest > 0.0 ? highest : last; /* of the effects still visible */
        }
        assert_true(most > (double)GROUND + 8.0);
        assert_true(last > 0.0 && last < most - 4.0);
        s->head.tick = began;
        s->effects.count = 0;
    }
}

static void test_the_first_effect_to_end_is_replaced(void **context)
{
    struct scene_stage *s = *context;
    struct event lasting = happening(s, EFFECT_BURST), brief = happening(s, EFFECT_FLASH);
    effects_take(&s->effects, &s->frame_view, &lasting, 1);
    for (uint32_t i = 0; i < 3 * EFFECTS_MAX; i++)
        effects_take(&s->effects, &s->frame_view, &brief, 1);
    assert_int_equal(s->effects.count, EFFECTS_MAX);
    assert_int_equal(s->effects.effect[0].type, EFFECT_BURST);
    for (uint32_t i = 0; i < 3 * EFFECTS_MAX; i++)
        effects_take(&s->effects, &s->frame_view, &lasting, 1);
    s->head.tick += 5;
    look(s, 40.0); /* more than the particle list can hold */
    assert_int_equal(s->list.particle_count, DRAW_LIST_PARTICLES_MAX);
    assert_true(s->list.omitted > 0);
}

/* --- wrecks ----------------------------------------------------------------------------------- */

static uint32_t put_wreck(struct scene_stage *s, double x, double z)
{
    uint32_t slot = put(s, TANK, x, 0.0, z);
    s->entities.row[slot].state = ENTITY_WRECK;
    s->entities.row[slot].damage = DAMAGE_DESTROYED;
    s->entities.row[slot].changed_tick = (uint32_t)s->head.tick;
    effects_take(&s->effects, &s->frame_view, NULL, 0);
    return slot;
}

static void test_a_wreck_bursts_once(void **context)
{
    struct scene_stage *s = *context;
    put_wreck(s, MIDDLE, MIDDLE);
    for (uint32_t i = 0; i < 10; i++)
        step(s);
    assert_int_equal(s->effects.count, 1);
    assert_int_equal(s->effects.effect[0].type, EFFECT_WRECK);
    assert_true(s->effects.effect[0].time_s == 6000.0 / HZ);
    /* Debris that is already there when a renderer starts is at rest. */
    uint32_t old = put(s, TANK, MIDDLE + 50.0, 0.0, MIDDLE);
    s->entities.row[old].state = ENTITY_WRECK;
    s->entities.row[old].changed_tick =
        (uint32_t)(s->head.tick - (uint64_t)(HZ * EFFECT_LIFE_S) - 60);
    step(s);
    assert_int_equal(s->effects.count, 1);
}

static void test_a_wreck_that_breaks_up_bursts_again(void **context)
{
    struct scene_stage *s = *context;
    uint32_t slot = put_wreck(s, MIDDLE, MIDDLE);
    step(s);
    s->entities.row[slot].flags |= ENTITY_FLAG_BROKEN;
    s->entities.row[slot].changed_tick = (uint32_t)s->head.tick;
    for (uint32_t i = 0; i < 10; i++)
        step(s);
    assert_int_equal(s->effects.count, 2);
    assert_int_equal(s->effects.effect[1].type, EFFECT_WRECK);
    assert_true(s->effects.effect[1].time_s > s->effects.effect[0].time_s);
}

static void test_debris_flies_and_comes_to_rest(void **context)
{
    struct scene_stage *s = *context;
    put_wreck(s, MIDDLE, MIDDLE);
    uint64_t began = s->head.tick;
    double most = 0.0;
    float rest[16][3] = {{0.0f}};
    uint32_t pieces = 0;
    for (uint32_t tick = 1; tick < (uint32_t)(20.0 * HZ); tick += 3) {
        s->head.tick = began + tick;
        look(s, 50.0);
        double eye = s->list.camera.eye.y - (double)GROUND;
        uint32_t seen = 0;
        for (uint32_t i = 0; i < s->list.body_count && seen < 16; i++) {
            const struct draw_list_body *body = &s->list.bodies[i];
            if (s->list.instances[i].detail != MESH_COARSEST)
                continue; /* the wreck itself */
            double above = (double)body->at[1] + eye;
            assert_true(above > -0.5);
            most = maths_max(most, above);
            if (tick > 10.0 * HZ) {
                assert_true(fabs(above) < 0.1); /* it lies flat */
                assert_true(body->up[1] > 0.0f && fabsf(body->forward[1]) < 1e-3f);
                bool moved = memcmp(rest[seen], body->at, sizeof rest[0]) != 0;
                assert_true(pieces == 0 || !moved);
                memcpy(rest[seen], body->at, sizeof rest[0]);
            }
            seen++;
        }
        if (tick > 10.0 * HZ)
            pieces = seen;
    }
    assert_true(most > 3.0);
    assert_true(pieces >= 4);
    s->head.tick = began + (uint64_t)((EFFECT_LIFE_S + 1.0) * HZ);
    look(s, 50.0);
    assert_int_equal(s->list.body_count, 1);
}

static void test_smoke_goes_on_when_damage_grows(void **context)
{
    struct scene_stage *s = *context;
    uint32_t slot = put(s, TANK, MIDDLE, 0.0, MIDDLE);
    s->entities.row[slot].damage = DAMAGE_MED;
    s->entities.row[slot].changed_tick = (uint32_t)s->head.tick;
    for (uint32_t i = 0; i < 900; i++)
        step(s);
    look(s, 60.0);
    double before = ink(s);
    s->entities.row[slot].damage = DAMAGE_HIGH;
    s->entities.row[slot].changed_tick = (uint32_t)s->head.tick;
    look(s, 60.0);
    assert_true(before > 0.0 && fabs(ink(s) - before) < 0.05 * before);
}

/* --- what moving things leave ----------------------------------------------------------------- */

/* Adds the dust of a tank that has driven to the middle. */
static double dust_on(struct scene_stage *s, enum cover cover, double speed)
{
    lay(s, cover);
    s->head.used = 0;
    memset(&s->effects, 0, sizeof s->effects);
    uint32_t slot = put(s, TANK, MIDDLE - 3.0 * speed, 0.0, MIDDLE);
    s->entities.row[slot].vx = speed;
    for (uint32_t i = 0; i < 180; i++)
        step(s);
    look(s, 50.0);
    return ink(s);
}

static void test_dust_depends_on_the_cover(void **context)
{
    struct scene_stage *s = *context;
    double sand = dust_on(s, COVER_SAND, 14.0);
    assert_true(sand > 0.0);
    double grass = dust_on(s, COVER_GRASS, 14.0);
    assert_true(grass > 0.1 * sand && grass < 0.7 * sand);
    assert_true(dust_on(s, COVER_FOREST, 14.0) == 0.0);
    assert_true(dust_on(s, COVER_LAKE, 14.0) == 0.0);
    assert_true(dust_on(s, COVER_SAND, 5.0) < 0.5 * sand);
    assert_true(dust_on(s, COVER_SAND, 1.0) == 0.0);
}

/* Dust stays in place whatever the vehicle does. */
static void test_dust_stays_when_the_vehicle_stops(void **context)
{
    struct scene_stage *s = *context;
    double before = dust_on(s, COVER_SAND, 14.0);
    s->entities.row[0].vx = 0.0;
    step(s);
    look(s, 50.0);
    assert_true(fabs(ink(s) - before) < 0.1 * before);
}

static void test_only_low_rotors_raise_dust(void **context)
{
    struct scene_stage *s = *context;
    uint32_t slot = put(s, CHOPPER, MIDDLE, 40.0, MIDDLE);
    look(s, 60.0);
    assert_int_equal(s->list.particle_count, 0);
    s->entities.row[slot].y = (double)GROUND + 3.0;
    look(s, 60.0);
    assert_true(s->list.particle_count > 5);
    lay(s, COVER_FOREST);
    look(s, 60.0);
    assert_int_equal(s->list.particle_count, 0);
    lay(s, COVER_SEA);
    look(s, 60.0);
    assert_true(s->list.particle_count > 5); /* spray */
}

static void test_a_ship_leaves_a_wake(void **context)
{
    struct scene_stage *s = *context;
    lay(s, COVER_SEA);
    uint32_t slot = put(s, SHIP, MIDDLE - 130.0, 0.0, MIDDLE - 60.0);
    s->entities.row[slot].vx = 13.0;
    s->entities.row[slot].heading = HALF_PI;
    for (uint32_t i = 0; i < 600; i++)
        step(s);
    look(s, 150.0);
    uint32_t behind = 0;
    double reach = s->entities.row[slot].x - 100.0 - MIDDLE;
    for (uint32_t i = 0; i < s->list.particle_count; i++)
        behind += (double)s->list.particles[i].at[0] < reach;
    assert_true(behind > 3);
}

/* The smoke of a missile that flies a circle lies on the circle, and stays when the missile is
 * gone. */
static void test_a_trail_is_where_the_missile_flew(void **context)
{
    struct scene_stage *s = *context;
    const double radius = 90.0, turn = 1.1; /* [m], [rad/s] */
    uint32_t slot = put(s, MISSILE, MIDDLE, 30.0, MIDDLE);
    s->entities.row[slot].born_tick = (uint32_t)s->head.tick;
    for (uint32_t i = 0; i < 150; i++) {
        double angle = turn * i / HZ;
        s->entities.row[slot].x = MIDDLE + radius * maths_cos(angle);
        s->entities.row[slot].z = MIDDLE - radius * maths_sin(angle);
        s->entities.row[slot].vx = -radius * turn * maths_sin(angle);
        s->entities.row[slot].vz = -radius * turn * maths_cos(angle);
        s->head.tick++;
        s->head.frame++;
        effects_take(&s->effects, &s->frame_view, NULL, 0);
    }
    for (uint32_t gone = 0; gone < 2; gone++) {
        if (gone) {
            struct event end = happening(s, EFFECT_SPLASH);
            end.detonation.munition.id = s->entities.row[slot].id;
            end.detonation.struck = STRUCK_AIR;
            end.detonation.explosive_kg = 0.0f;
            end.detonation.point[0] = s->entities.row[slot].x;
            end.detonation.point[1] = s->entities.row[slot].y;
            end.detonation.point[2] = s->entities.row[slot].z;
            s->entities.row[slot].state = ENTITY_FREE;
            effects_take(&s->effects, &s->frame_view, &end, 1);
        }
        look(s, 300.0);
        uint32_t smoke = 0;
        for (uint32_t i = 0; i < s->list.particle_count; i++) {
            const struct draw_list_particle *particle = &s->list.particles[i];
            if (particle->glow > 0.0f)
                continue;
            double x = (double)particle->at[0] + s->list.camera.eye.x - MIDDLE;
            double z = (double)particle->at[2] + s->list.camera.eye.z - MIDDLE;
            /* The wind moves it by 5 m at most. */
            assert_true(fabs(sqrt(x * x + z * z) - radius) < 6.0);
            smoke++;
        }
        assert_true(smoke > 15);
    }
    s->head.tick += (uint64_t)(5.0 * HZ);
    look(s, 300.0);
    assert_int_equal(s->list.particle_count, 0);
}

static void test_the_curve_is_smooth_and_ends_at_birth(void **context)
{
    (void)context;
    uint64_t random = fixture_seed(11);
    for (uint32_t round = 0; round < 200; round++) {
        static struct motion_trail trail;
        double turn = fixture_uniform(&random, -0.7, 0.7), speed = fixture_uniform(&random, 5, 400);
        double gap = fixture_uniform(&random, 0.1, 0.4);
        struct motion_trail_point now = {.time_s = 0.0};
        trail.count = 0;
        for (uint32_t i = 0; i < 20; i++) {
            double t = gap * i, radius = speed / maths_max(fabs(turn), 1e-3);
            struct motion_trail_point point = {
                .at = {(float)(radius * maths_sin(t * turn)), 5.0f,
                       (float)(radius * (1.0 - maths_cos(t * turn)))},
                .velocity = {(float)(radius * turn * maths_cos(t * turn)), 0.0f,
                             (float)(radius * turn * maths_sin(t * turn))},
                .time_s = t};
            now = point;
            trail.point[trail.count++ % MOTION_TRAIL_POINTS] = point;
        }
        for (uint32_t i = 0; i < 50; i++) {
            double t = now.time_s - fixture_uniform(&random, 0.0, gap * (MOTION_TRAIL_POINTS - 1));
            double radius = speed / maths_max(fabs(turn), 1e-3);
            struct motion_trail_point is = motion_trail_at(&trail, &now, t);
            double x = radius * maths_sin(t * turn), z = radius * (1.0 - maths_cos(t * turn));
            assert_true(fabs((double)is.at[0] - x) < 0.001 * speed + 0.05);
            assert_true(fabs((double)is.at[2] - z) < 0.001 * speed + 0.05);
        }
    }
}

/* --- pictures that hold still ----------------------------------------------------------------- */

static void furnish(struct scene_stage *s)
{
    static const enum effect_type types[] = {EFFECT_FLASH, EFFECT_EXPLOSION, EFFECT_BURST,
                                             EFFECT_SPLASH, EFFECT_HIT};
    for (uint32_t i = 0; i < 5; i++) {
        struct event event = happening(s, types[i]);
        event.index = i;
        effects_take(&s->effects, &s->frame_view, &event, 1);
    }
    uint32_t tank = put(s, TANK, MIDDLE - 60.0, 0.0, MIDDLE - 10.0);
    s->entities.row[tank].vx = 12.0;
    uint32_t missile = put(s, MISSILE, MIDDLE - 100.0, 20.0, MIDDLE - 20.0);
    s->entities.row[missile].vx = 150.0;
    uint32_t shell = put(s, SHELL, MIDDLE, 5.0, MIDDLE);
    s->entities.row[shell].vx = 30.0;
    put(s, CHOPPER, MIDDLE + 15.0, 4.0, MIDDLE);
    put_wreck(s, MIDDLE + 5.0, MIDDLE);
}

static void test_the_same_frame_gives_the_same_lists(void **context)
{
    struct scene_stage *s = *context;
    furnish(s);
    for (uint32_t i = 0; i < 45; i++)
        step(s);
    look(s, 45.0);
    struct draw_list first = s->list;
    assert_true(first.particle_count > 100 && first.body_count > 8);
    /* With other memory, used for another camera before; frames advance and time does not. */
    assert_int_equal(scene_init(&s->list), 0);
    look(s, 3.0);
    s->head.frame += 1000;
    effects_take(&s->effects, &s->frame_view, NULL, 0);
    look(s, 45.0);
    assert_int_equal(s->list.particle_count, first.particle_count);
    assert_int_equal(s->list.body_count, first.body_count);
    assert_memory_equal(s->list.particles, first.particles,
                        first.particle_count * sizeof *first.particles);
    assert_memory_equal(s->list.bodies, first.bodies, first.body_count * sizeof *first.bodies);
    assert_memory_equal(s->list.instances, first.instances,
                        first.body_count * sizeof *first.instances);
    scene_free(&first);
}

static void test_nothing_appears_or_vanishes_suddenly(void **context)
{
    struct scene_stage *s = *context;
    put_wreck(s, MIDDLE, MIDDLE);
    for (uint32_t i = 0; i < 1500; i++)
        step(s);
    /* Along time, from a distance at which all of it is in view. */
    look(s, 250.0);
    double before = ink(s);
    for (uint32_t i = 0; i < 120; i++) {
        step(s);
        look(s, 250.0);
        assert_true(fabs(ink(s) - before) < 0.02 * before);
        before = ink(s);
    }
    /* As the camera moves away, sizes shrink and levels of detail change. */
    for (double away = 250.0; away < 4000.0; away *= 1.01) {
        look(s, away);
        before = ink(s);
        look(s, 1.001 * away);
        assert_true(fabs(ink(s) - before) < 0.01 * before);
    }
}

static void test_fewer_particles_far_away(void **context)
{
    struct scene_stage *s = *context;
    put_wreck(s, MIDDLE, MIDDLE);
    for (uint32_t i = 0; i < 1800; i++)
        step(s);
    look(s, 250.0);
    uint32_t near = s->list.particle_count;
    look(s, 1000.0);
    uint32_t far = s->list.particle_count;
    look(s, 3000.0);
    assert_true(near < 60 && far < near && s->list.particle_count < far);
    assert_in_range(s->list.particle_count, 3, 14);
}

static void test_less_detail_is_less_to_draw(void **context)
{
    struct scene_stage *s = *context;
    furnish(s);
    lay(s, COVER_CHAPARRAL);
    s->params.renderer.texture = 1;
    for (uint32_t i = 0; i < 45; i++)
        step(s);
    uint32_t plants = UINT32_MAX, particles = UINT32_MAX;
    for (float detail = 1.0f; detail > 0.05f; detail *= 0.7f) {
        s->list.detail = detail;
        look(s, 45.0);
        assert_true(s->list.plant_count < plants && s->list.particle_count <= particles);
        plants = s->list.plant_count;
        particles = s->list.particle_count;
    }
    s->list.detail = 1.0f;
    look(s, 45.0);
    assert_true(particles < s->list.particle_count / 2);
}

static void test_no_particle_around_the_eye(void **context)
{
    struct scene_stage *s = *context;
    struct event event = happening(s, EFFECT_EXPLOSION);
    effects_take(&s->effects, &s->frame_view, &event, 1);
    s->head.tick += 60;
    for (double away = 0.3; away < 40.0; away *= 1.2) {
        look(s, away);
        for (uint32_t i = 0; i < s->list.particle_count; i++) {
            const struct draw_list_particle *particle = &s->list.particles[i];
            float far = sqrtf(frustum_dot(particle->at, particle->at));
            assert_true(far > 0.6f * particle->size && particle->colour[3] > 0.0f);
        }
    }
}

static void test_particles_are_sorted_farthest_first(void **context)
{
    struct scene_stage *s = *context;
    furnish(s);
    for (uint32_t i = 0; i < 30; i++)
        step(s);
    look(s, 45.0);
    assert_true(s->list.particle_count > 100);
    for (uint32_t i = 1; i < s->list.particle_count; i++) {
        const float *a = s->list.particles[i - 1].at, *b = s->list.particles[i].at;
        assert_true(frustum_dot(a, a) >= frustum_dot(b, b));
    }
}

/* --- grass ------------------------------------------------------------------------------------ */

static void test_grass_does_not_grow_in_craters(void **context)
{
    struct scene_stage *s = *context;
    lay(s, COVER_CHAPARRAL);
    s->params.renderer.texture = 1;
    look(s, 30.0);
    uint32_t before = s->list.plant_count;
    s->craters[0] = (struct crater){MIDDLE, MIDDLE, 12.0f, 3.0f, 1};
    crater_index_update(&s->index, 1);
    look(s, 30.0);
    assert_true(before > 500 && s->list.plant_count < before);
    for (uint32_t i = 0; i < s->list.plant_count; i++) {
        double x = (double)s->list.plants[i].at[0] + s->list.camera.eye.x - MIDDLE;
        double z = (double)s->list.plants[i].at[2] + s->list.camera.eye.z - MIDDLE;
        assert_true(x * x + z * z > 100.0);
    }
}

static void test_grass_grows_into_the_picture(void **context)
{
    struct scene_stage *s = *context;
    lay(s, COVER_CHAPARRAL);
    s->params.renderer.texture = 1;
    look(s, 30.0);
    uint32_t small = 0;
    for (uint32_t i = 0; i < s->list.plant_count; i++) {
        const struct draw_list_plant *plant = &s->list.plants[i];
        float far = sqrtf(frustum_dot(plant->at, plant->at));
        assert_true((double)far < GRASS_RANGE_M);
        if ((double)far > 0.99 * GRASS_RANGE_M)
            assert_true(plant->height < 0.3f);
        small += plant->height < 0.1f;
    }
    assert_true(small > 0);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_stage, scene_stage_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_each_event_shows_for_its_time),
        TEST(test_a_shot_out_of_the_sky_has_no_muzzle),
        TEST(test_a_flash_points_along_its_round),
        TEST(test_soil_and_water_fall_back),
        TEST(test_the_first_effect_to_end_is_replaced),
        TEST(test_a_wreck_bursts_once),
        TEST(test_a_wreck_that_breaks_up_bursts_again),
        TEST(test_debris_flies_and_comes_to_rest),
        TEST(test_smoke_goes_on_when_damage_grows),
        TEST(test_dust_depends_on_the_cover),
        TEST(test_dust_stays_when_the_vehicle_stops),
        TEST(test_only_low_rotors_raise_dust),
        TEST(test_a_ship_leaves_a_wake),
        TEST(test_a_trail_is_where_the_missile_flew),
        TEST(test_the_curve_is_smooth_and_ends_at_birth),
        TEST(test_the_same_frame_gives_the_same_lists),
        TEST(test_nothing_appears_or_vanishes_suddenly),
        TEST(test_fewer_particles_far_away),
        TEST(test_less_detail_is_less_to_draw),
        TEST(test_no_particle_around_the_eye),
        TEST(test_particles_are_sorted_farthest_first),
        TEST(test_grass_does_not_grow_in_craters),
        TEST(test_grass_grows_into_the_picture),
    };
    return cmocka_run_group_tests_name("effects", tests, NULL, NULL);
}
