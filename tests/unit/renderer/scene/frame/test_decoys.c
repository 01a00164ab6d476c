/* Flares and smoke in pictures: who releases them, when, and that they are drawn. */
#include "renderer/scene/frame/decoys.h"

#include "renderer/scene/scene.h"
#include "tests/support/scene_stage.h"
#include "world/entity/smoke.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define HZ     60.0
#define MIDDLE 25000.0 /* [m] */
#define GROUND 100.0   /* [m] */

enum { TANK, JET, MISSILE, KINDS };

static const struct kind kinds[KINDS] = {
    [TANK] =
        {.domain = DOMAIN_LAND, .radius_m = 3.5, .length_m = 7.0, .width_m = 3.6, .height_m = 2.4},
    [JET] =
        {.domain = DOMAIN_AIR, .radius_m = 7.0, .length_m = 15.0, .width_m = 10.0, .height_m = 3.6},
    [MISSILE] = {.domain = DOMAIN_MUNITION,
                 .guidance = GUIDANCE_HOMING,
                 .radius_m = 0.2,
                 .length_m = 3.0,
                 .max_speed_mps = 500.0},
};

static int open_stage(void **context)
{
    struct scene_stage *s = scene_stage_new(8, 1);
    s->params.hz = HZ;
    s->params.dt_s = 1.0 / HZ;
    for (uint32_t i = 0; i < SCENE_STAGE_POSTS * SCENE_STAGE_POSTS; i++)
        s->posts[i] = (float)GROUND;
    s->world.kinds = kinds;
    s->world.counts.kinds = KINDS;
    scene_stage_ready(s);
    s->head.frame = s->head.tick = 6000;
    *context = s;
    return 0;
}

static uint32_t put(struct scene_stage *s, uint16_t kind, double x, double y, double vx)
{
    uint32_t slot = s->head.used++;
    const struct entities *e = &s->entities;
    e->row[slot].id = slot + 1;
    e->row[slot].state = ENTITY_ACTIVE;
    e->row[slot].behaviour = kind == MISSILE ? BEHAVIOUR_FLIGHT : BEHAVIOUR_PATROL;
    e->row[slot].kind = kind;
    e->row[slot].x = x;
    e->row[slot].y = y;
    e->row[slot].z = MIDDLE;
    e->row[slot].vx = vx;
    return slot;
}

/* Puts a target, and a missile that follows it at a distance and closes at 400 m/s. */
static uint32_t put_pair(struct scene_stage *s, uint16_t kind, double away_m)
{
    double high = GROUND + (kind == JET ? 300.0 : 0.0), speed = kind == JET ? 100.0 : 0.0;
    uint32_t target = put(s, kind, MIDDLE, high, speed);
    uint32_t missile = put(s, MISSILE, MIDDLE - away_m, high, speed + 400.0);
    s->entities.row[missile].target_slot = target;
    s->entities.row[missile].target_id = s->entities.row[target].id;
    return target;
}

static uint32_t released(const struct scene_stage *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->effects.count; i++)
        count += s->effects.effect[i].type == EFFECT_DECOY;
    return count;
}

static uint32_t particles(struct scene_stage *s)
{
    struct camera camera;
    struct vec3 middle = {MIDDLE, s->entities.row[0].y, MIDDLE};
    camera_look(&camera, vec3_add(middle, (struct vec3){0.0, 20.0, 150.0}), middle, 1280, 720);
    scene_build(&s->list, &camera, &s->static_scene, &s->frame_view, &s->effects);
    return s->list.particle_count;
}

static void test_decoys_are_out_before_a_missile_arrives(void **context)
{
    static const uint16_t targets[] = {JET, TANK};
    struct scene_stage *s = *context;
    for (uint32_t n = 0; n < 2; n++) {
        s->head.used = s->effects.count = 0;
        put_pair(s, targets[n], 1600.0); /* 4 s away */
        decoys_take(&s->effects, &s->frame_view);
        assert_int_equal(released(s), 0);
        s->entities.row[1].x = MIDDLE - 1400.0;
        decoys_take(&s->effects, &s->frame_view);
        assert_int_equal(released(s), 1);
        uint32_t quiet = particles(s);
        s->head.tick += (uint64_t)(0.2 * HZ);
        decoys_take(&s->effects, &s->frame_view);
        assert_int_equal(released(s), 1);
        assert_true(particles(s) > quiet);
        s->head.tick += (uint64_t)(0.2 * HZ);
        decoys_take(&s->effects, &s->frame_view);
        assert_int_equal(released(s), 2);
        s->head.tick += (uint64_t)(effects_life_s(EFFECT_DECOY) * HZ) + 1;
        s->head.used = 0;
        assert_int_equal(particles(s), 0);
    }
}

static void test_a_crew_that_fires_its_grenades_is_seen_in_smoke(void **context)
{
    struct scene_stage *s = *context;
    uint32_t row = put(s, TANK, MIDDLE, GROUND, 0.0);
    decoys_take(&s->effects, &s->frame_view);
    assert_int_equal(released(s), 0);
    s->head.tick += 10;
    s->entities.row[row].owner_slot = (uint32_t)s->head.tick;
    for (double s_after = 0.0; s_after < SMOKE_S + 4.0; s_after += 0.5) {
        s->head.tick += (uint64_t)(0.5 * HZ);
        decoys_take(&s->effects, &s->frame_view);
    }
    assert_in_range(released(s), 4, 6);
}

static void test_who_reacts_to_nothing_releases_none(void **context)
{
    struct scene_stage *s = *context;
    uint32_t target = put_pair(s, JET, 500.0);
    s->entities.row[target].behaviour = BEHAVIOUR_HOLD;
    decoys_take(&s->effects, &s->frame_view);
    assert_int_equal(released(s), 0);
    s->entities.row[target].behaviour = BEHAVIOUR_PATROL;
    s->entities.row[1].target_id = 0; /* the missile has lost it */
    decoys_take(&s->effects, &s->frame_view);
    assert_int_equal(released(s), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_decoys_are_out_before_a_missile_arrives, open_stage,
                                        scene_stage_teardown),
        cmocka_unit_test_setup_teardown(test_a_crew_that_fires_its_grenades_is_seen_in_smoke,
                                        open_stage, scene_stage_teardown),
        cmocka_unit_test_setup_teardown(test_who_reacts_to_nothing_releases_none, open_stage,
                                        scene_stage_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
