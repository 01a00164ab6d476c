/* The choice of the followed vehicle, and where its camera looks. */
#include "renderer/scene/camera/follow.h"

#include "tests/support/scene_stage.h"
#include "world/params.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>

#define CAPACITY 16u

enum { TANK, ROUND, SHELL, BULLET, HOWITZER, KINDS };

static const struct kind kinds[KINDS] = {
    [TANK] = {.name = "tank", .domain = DOMAIN_LAND, .radius_m = 4.0},
    [ROUND] = {.name = "round", .domain = DOMAIN_MUNITION},
    [SHELL] = {.name = "shell", .domain = DOMAIN_MUNITION, .delivery = DELIVERY_ARC},
    [BULLET] = {.name = "bullet", .domain = DOMAIN_MUNITION, .penetration_mm = 20.0},
    [HOWITZER] = {.name = "howitzer", .domain = DOMAIN_LAND, .radius_m = 4.0, .munition = SHELL},
};

static int open_stage(void **context)
{
    struct scene_stage *s = scene_stage_new(CAPACITY, 0);
    s->params.hz = 10.0;
    s->params.dt_s = 0.1;
    s->world.kinds = kinds;
    s->world.counts.kinds = KINDS;
    scene_stage_ready(s);
    *context = s;
    return 0;
}

static uint32_t put_tank(struct scene_stage *s, double x, double z, double heading)
{
    return scene_stage_put(s, TANK, x, z, heading);
}

static void test_follow_keeps_its_choice(void **context)
{
    struct scene_stage *s = *context;
    struct follow follow = {.id = 0};
    put_tank(s, 10000.0, 10000.0, 0.0);
    uint32_t moving = put_tank(s, 20000.0, 20000.0, 0.0);
    s->entities.row[moving].vx = 10.0;
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 0, false), moving);
    s->entities.row[moving].vx = 0.0;
    s->entities.row[0].vx = 10.0;
    s->head.tick = 50; /* after 5 s it is kept, though another is livelier */
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 0, false), moving);
    s->head.tick = 200;
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 0, false), 0);
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 2, false), 1);
    s->entities.row[1].state = ENTITY_WRECK;
    s->entities.row[1].changed_tick = 200;
    struct follow nobody = {.id = 0}; /* a renderer that has just started also sees it burn */
    assert_int_equal(follow_choose(&nobody, &s->frame_view, &s->effects, 2, false), 1);
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 2, false), 1);
    s->head.tick = 200 + 10 * (uint64_t)(FOLLOW_WRECK_S + 1.0);
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 2, false), 0);
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 2, true), 1);
}

/* A tank that drives among others is quiet beside one whose round is in the air, and so is a herd.
 */
static void test_follow_goes_to_the_fire(void **context)
{
    struct scene_stage *s = *context;
    struct follow follow = {.id = 0};
    uint32_t driver = put_tank(s, 10000.0, 10000.0, 0.0);
    for (int n = 0; n < 12; n++)
        put_tank(s, 10000.0, 9850.0, 0.0);
    s->entities.row[driver].vx = 10.0;
    uint32_t shooter = put_tank(s, 20000.0, 20000.0, 0.0);
    uint32_t target = put_tank(s, 21000.0, 20000.0, 0.0);
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 0, false), driver);
    uint32_t round = put_tank(s, 20500.0, 20000.0, 0.0);
    s->entities.row[round].behaviour = BEHAVIOUR_FLIGHT;
    s->entities.row[round].kind = ROUND;
    s->entities.row[round].owner_slot = shooter;
    s->entities.row[round].owner_id = s->entities.row[shooter].id;
    s->entities.row[round].target_slot = target;
    s->entities.row[round].target_id = s->entities.row[target].id;
    s->head.tick = 50; /* not before FOLLOW_KEEP_S */
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 0, false), driver);
    s->head.tick = 200;
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 0, false), shooter);
    /* The target is as lively when it fires, but not so much livelier that the camera changes. */
    s->entities.row[target].vx = 4.0;
    s->head.tick = 400;
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 0, false), shooter);
    /* A howitzer shows nothing but a gun: its shells come down kilometres away. */
    s->entities.row[round].kind = SHELL;
    s->entities.row[target].vx = 0.0;
    s->head.tick = 600;
    assert_int_equal(follow_choose(&follow, &s->frame_view, &s->effects, 0, false), driver);
}

/* Explosions and burning wrecks beside a vehicle draw the camera, those that are over do not, and
 * neither does the flash of a gun. */
static void test_follow_goes_to_what_burns(void **context)
{
    struct scene_stage *s = *context;
    uint32_t driver = put_tank(s, 10000.0, 10000.0, 0.0);
    s->entities.row[driver].vx = 10.0;
    uint32_t other = put_tank(s, 20000.0, 20000.0, 0.0);
    struct effect *effect = effects_allocate(&s->effects);
    static const struct {
        uint32_t type;
        double age_s;
        bool draws;
    } cases[] = {{EFFECT_FLASH, 0.1, false},
                 {EFFECT_BURST, 0.5, true},
                 {EFFECT_BURST, 8.0, false},
                 {EFFECT_WRECK, 20.0, true},
                 {EFFECT_WRECK, EFFECT_LIFE_S, false}};
    s->head.tick = 1000;
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        struct follow first = {.id = 0};
        *effect = (struct effect){.point = {20020.0, s->entities.row[other].y, 20000.0},
                                  .time_s = 100.0 - cases[n].age_s,
                                  .type = cases[n].type};
        assert_int_equal(follow_choose(&first, &s->frame_view, &s->effects, 0, false),
                         cases[n].draws ? other : driver);
    }
}

/* Of two tanks that drive the one behind whose target are others is livelier, a gun that fires at
 * what is kilometres away is not, and the fire of machine guns counts less than that of tanks. */
static void test_follow_weighs_what_is_to_be_seen(void **context)
{
    struct scene_stage *s = *context;
    struct follow follow = {.id = 0};
    struct entities *e = &s->entities;
    uint32_t driver = put_tank(s, 10000.0, 10000.0, 0.0);
    uint32_t gun = put_tank(s, 20000.0, 20000.0, 0.0);
    e->row[driver].vx = 10.0;
    e->row[gun].kind = HOWITZER;
    for (int n = 0; n < 8; n++)
        put_tank(s, 20000.0, 19850.0, 0.0);
    e->row[put_tank(s, 40000.0, 40000.0, 0.0)].vx = 10.0;
    assert_true(follow_choose(&follow, &s->frame_view, &s->effects, 0, false) != gun);
    uint32_t rounds[2] = {s->head.used, s->head.used + 1}, shooters[2] = {driver, gun};
    for (int n = 0; n < 2; n++) {
        put_tank(s, 20500.0, 20000.0, 0.0);
        e->row[rounds[n]].behaviour = BEHAVIOUR_FLIGHT;
        e->row[rounds[n]].kind = ROUND;
        e->row[rounds[n]].owner_slot = shooters[n];
        e->row[rounds[n]].owner_id = e->row[shooters[n]].id;
    }
    e->row[gun].kind = TANK;
    e->row[gun].vx = 10.0;
    e->row[rounds[1]].kind = BULLET;
    struct follow first = {.id = 0};
    assert_int_equal(follow_choose(&first, &s->frame_view, &s->effects, 0, false), driver);
}

/* It looks at its target, without one at recent explosions, and otherwise ahead. */
static void test_follow_looks_at_what_happens(void **context)
{
    struct scene_stage *s = *context;
    struct entities *e = &s->entities;
    uint32_t row = put_tank(s, 10000.0, 10000.0, 1.0);
    uint32_t target = put_tank(s, 11000.0, 10000.0, 0.0);
    s->head.tick = 100;
    assert_true(follow_look(&s->frame_view, &s->effects, row).heading_rad == 1.0);
    struct effect *effect = effects_allocate(&s->effects);
    *effect = (struct effect){
        .point = {10000.0, e->row[row].y, 10200.0}, .time_s = 9.0, .type = EFFECT_BURST};
    assert_true(fabs(follow_look(&s->frame_view, &s->effects, row).heading_rad - PI) < 0.01);
    e->row[row].behaviour = BEHAVIOUR_ATTACK;
    e->row[row].target_slot = target;
    e->row[row].target_id = e->row[target].id;
    assert_true(fabs(follow_look(&s->frame_view, &s->effects, row).heading_rad - HALF_PI) < 0.01);
    e->row[target].state = ENTITY_FREE; /* it is gone */
    assert_true(fabs(follow_look(&s->frame_view, &s->effects, row).heading_rad - PI) < 0.01);
    effect->point.z = 13000.0;
    assert_true(follow_look(&s->frame_view, &s->effects, row).heading_rad == 1.0);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_stage, scene_stage_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_follow_keeps_its_choice),      TEST(test_follow_goes_to_the_fire),
        TEST(test_follow_goes_to_what_burns),    TEST(test_follow_weighs_what_is_to_be_seen),
        TEST(test_follow_looks_at_what_happens),
    };
    return cmocka_run_group_tests_name("follow", tests, NULL, NULL);
}
