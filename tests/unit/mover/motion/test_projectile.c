/* Munitions: exact parabolas, drag as published, and missiles that hit moving targets. */
#include "tests/support/steps.h"
#include "world/params.h"
#include "world/world.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static uint32_t put_round(const char *kind, struct vec3 at, struct vec3 velocity)
{
    return fixture_put(&f, (struct fixture_entity){.kind = kind, .at = at, .velocity = velocity});
}

/* --- ballistic ---------------------------------------------------------------------------------*/

static void follow_parabola(double hz)
{
    const struct vec3 at = {20000.0, 3000.0, 25000.0}, v = {400.0, 250.0, -120.0};
    uint32_t row = put_round("artillery", at, v);
    steps_kind(&f, "artillery")->drag = DRAG_NONE;
    for (int frame = 1; frame <= (int)(20.0 * hz); frame++) {
        double t = frame / hz;
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        assert_true(fabs(e.x[row] - (at.x + v.x * t)) < 1e-7);
        assert_true(fabs(e.z[row] - (at.z + v.z * t)) < 1e-7);
        assert_true(fabs(e.y[row] - (at.y + v.y * t - 0.5 * GRAVITY_MPS2 * t * t)) < 1e-7);
        assert_true(fabs(e.vy[row] - (v.y - GRAVITY_MPS2 * t)) < 1e-9);
        assert_true(e.vx[row] == v.x && e.vz[row] == v.z);
        assert_true(fabs(e.pitch[row] - atan2(e.vy[row], hypot(v.x, v.z))) < 1e-12);
        assert_true(fabs(e.heading[row] - atan2(v.x, -v.z)) < 1e-12);
    }
}

static void test_a_ballistic_round_follows_the_parabola(void **state)
{
    (void)state;
    follow_parabola(60.0);
}

static void test_the_parabola_does_not_depend_on_the_frame_rate(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 10.0; };");
    follow_parabola(10.0);
}

/* --- drag --------------------------------------------------------------------------------------*/

/* Runs until the row has gone far_m from its start or ends. Returns the time [s]. */
static double fly(uint32_t row, double far_m, struct vec3 *at, struct vec3 *velocity)
{
    double start = steps_rows(&f).x[row], hz = 1.0 / world_dt_s(&f.view.world);
    for (int frame = 0;; frame++) {
        struct entities e = steps_rows(&f);
        if (e.state[row] == ENTITY_FREE || e.x[row] - start >= far_m)
            return frame / hz;
        *at = entities_position(&e, row), *velocity = entities_velocity(&e, row);
        fixture_run(&f, 1);
    }
}

static void test_a_sabot_round_is_as_fast_as_published(void **state)
{
    struct vec3 at, v;
    uint32_t row =
        put_round("shell", (struct vec3){20000.0, 120.0, 25000.0}, (struct vec3){1500.0, 0.0, 0.0});
    (void)state;
    double time = fly(row, 2000.0, &at, &v);
    assert_true(fabs(time - 1.40) < 0.02);
    assert_true(fabs(v.x / 1364.0 - 1.0) < 0.03);
}

/* The M107 shell with its strongest charge reaches 14.6 km. To 10 km it flies for 28.9 s at 18.5
 * degrees and comes down with 301 m/s at 27 degrees. */
static void fire_howitzer(double hz, double elevation_deg, double range_m, double time_s)
{
    double sine, cosine;
    struct vec3 at, v;
    char world[64];
    (void)snprintf(world, sizeof world, "world = { seed = 1; capacity = 64; hz = %.1f; };", hz);
    fixture_close(&f);
    fixture_open(&f, world);
    maths_sincos(elevation_deg * RAD_PER_DEG, &sine, &cosine);
    double height = FIXTURE_GROUND_M;
    uint32_t row = put_round("artillery", (struct vec3){20000.0, height, 25000.0},
                             (struct vec3){564.0 * cosine, 564.0 * sine, 0.0});
    double time = fly(row, 30000.0, &at, &v);
    assert_true(fabs((at.x - 20000.0) / range_m - 1.0) < 0.02);
    assert_true(fabs(time / time_s - 1.0) < 0.02);
    if (range_m == 10000.0) {
        assert_true(fabs(vec3_length(v) / 301.0 - 1.0) < 0.02);
        assert_true(fabs(atan2(-v.y, v.x) / RAD_PER_DEG - 27.0) < 0.7);
    }
}

static void test_a_howitzer_reaches_what_is_published(void **state)
{
    (void)state;
    for (double hz = 10.0; hz <= 60.0; hz += 50.0) {
        fire_howitzer(hz, 18.5, 10000.0, 28.9);
        fire_howitzer(hz, 47.0, 14600.0, 60.5);
    }
}

/* --- the end -----------------------------------------------------------------------------------*/

static void test_a_round_ends_in_the_air_when_its_life_is_over(void **state)
{
    const struct kind *kind = steps_kind(&f, "shell");
    uint32_t row =
        put_round("shell", (struct vec3){25000.0, 3000.0, 25000.0}, (struct vec3){0.0, 0.0, 100.0});
    uint32_t frames = (uint32_t)(kind->life_s * 60.0);
    (void)state;
    fixture_run(&f, frames - 1);
    assert_int_equal(steps_rows(&f).state[row], ENTITY_ACTIVE);
    fixture_run(&f, 1);
    assert_int_equal(steps_rows(&f).state[row], ENTITY_FREE);
    const struct event *event = fixture_event(&f, EVENT_DETONATION, 0);
    assert_non_null(event);
    assert_int_equal(event->detonation.struck, STRUCK_AIR);
    assert_int_equal(event->frame, frames);
    assert_int_equal(fixture_state(&f).head->munitions, 0);
}

/* --- homing ------------------------------------------------------------------------------------*/

static uint32_t put_missile(uint32_t target, struct vec3 at, struct vec3 velocity)
{
    uint32_t row = put_round("missile", at, velocity);
    struct entities e = steps_rows(&f);
    e.target_slot[row] = target;
    e.target_id[row] = target == SLOT_NONE ? 0 : e.id[target];
    return row;
}

static void test_a_missile_reaches_a_crossing_jet(void **state)
{
    static const double courses[][2] = {{230.0, 0.0}, {-230.0, 0.0}, {0.0, 150.0}, {160.0, -160.0}};
    (void)state;
    for (size_t n = 0; n < sizeof courses / sizeof courses[0]; n++) {
        uint32_t jet = fixture_put(
            &f, (struct fixture_entity){.kind = "jet",
                                        .at = {25000.0, 800.0, 23000.0},
                                        .velocity = {courses[n][0], 0.0, courses[n][1]}});
        uint32_t id = steps_rows(&f).id[jet];
        put_missile(jet, (struct vec3){25000.0, 150.0, 25000.0}, (struct vec3){0.0, 40.0, -100.0});
        fixture_run(&f, 60 * 15);
        const struct event *event = fixture_event(&f, EVENT_DETONATION, 0);
        assert_non_null(event);
        assert_int_equal(event->detonation.struck, STRUCK_VEHICLE);
        assert_int_equal(event->detonation.struck_party.id, id);
        fixture_close(&f);
        fixture_open(&f, "");
    }
}

static void test_what_leaves_the_seekers_cone_is_lost_for_good(void **state)
{
    uint32_t jet = fixture_put(&f, (struct fixture_entity){.kind = "jet",
                                                           .at = {25000.0, 900.0, 24000.0},
                                                           .velocity = {200.0, 0.0, 0.0}});
    double cone = steps_kind(&f, "missile")->seeker_rad;
    (void)state;
    for (int out = 0; out < 2; out++) { /* just within, and just outside */
        double off = cone + (out ? 0.05 : -0.05);
        uint32_t row =
            put_missile(jet, (struct vec3){25000.0, 900.0, 25000.0},
                        (struct vec3){100.0 * maths_sin(off), 0.0, -100.0 * maths_cos(off)});
        struct entities e = steps_rows(&f);
        double heading = e.heading[row];
        fixture_run(&f, 1);
        e = steps_rows(&f);
        assert_int_equal(e.target_id[row], out ? 0 : e.id[jet]);
        assert_true((fabs(maths_wrap_half(e.heading[row] - heading)) < 1e-9) == (out == 1));
        if (out == 1) { /* it comes into view again: too late */
            e.x[jet] = e.x[row] + 1000.0 * maths_sin(off);
            e.z[jet] = e.z[row] - 1000.0 * maths_cos(off);
            fixture_run(&f, 30);
            assert_true(fabs(maths_wrap_half(steps_rows(&f).heading[row] - heading)) < 1e-9);
        }
    }
}

/* Crossing jets that turn all the time, from all sides: the least distance on the path. */
static void test_missiles_meet_targets_that_turn_away(void **state)
{
    uint64_t random = fixture_seed(5);
    int hits = 0, shots = 60;
    (void)state;
    steps_params(&f)->collision.response = MODEL_NONE;
    for (int n = 0; n < shots; n++) {
        steps_empty(&f);
        double bearing = fixture_uniform(&random, 0.0, TWO_PI);
        double course = fixture_uniform(&random, 0.0, TWO_PI);
        double distance = fixture_uniform(&random, 800.0, 4500.0);
        double speed = fixture_uniform(&random, 70.0, 240.0);
        uint32_t jet = fixture_put(
            &f, (struct fixture_entity){
                    .kind = "jet",
                    .at = {25000.0 + distance * maths_sin(bearing), 900.0,
                           25000.0 - distance * maths_cos(bearing)},
                    .velocity = {speed * maths_sin(course), 0.0, -speed * maths_cos(course)},
                    .behaviour = BEHAVIOUR_DRIVEN});
        struct entities e = steps_rows(&f);
        struct vec3 at = {25000.0, 500.0, 25000.0};
        struct vec3 way =
            vec3_sub(vec3_add(entities_position(&e, jet),
                              vec3_scale(entities_velocity(&e, jet), distance / 380.0)),
                     at);
        e.steer[jet] = fixture_random(&random) % 2 ? 0.7f : -0.7f;
        e.throttle[jet] = 0.5f;
        uint32_t row = put_missile(jet, at, vec3_scale(way, 114.0 / vec3_length(way)));
        uint32_t id = steps_rows(&f).id[row];
        for (int frame = 0; frame < 60 * 20 && steps_find(&f, id) != SLOT_NONE; frame++)
            fixture_run(&f, 1);
        uint32_t ends = fixture_event_count(&f, EVENT_DETONATION);
        const struct event *end = fixture_event(&f, EVENT_DETONATION, ends - 1);
        hits += end != NULL && end->detonation.struck == STRUCK_VEHICLE;
    }
    print_message("%d of %d missiles struck\n", hits, shots);
    assert_true(hits >= shots * 9 / 10);
}

static void test_a_missile_turns_and_gains_speed_within_its_means(void **state)
{
    const struct kind *kind = steps_kind(&f, "missile");
    uint32_t jet = fixture_put(&f, (struct fixture_entity){.kind = "jet",
                                                           .at = {25000.0, 900.0, 26500.0},
                                                           .velocity = {200.0, 0.0, 0.0}});
    uint32_t row = put_missile(jet, (struct vec3){25000.0, 500.0, 25000.0},
                               (struct vec3){0.0, 0.0, -114.0}); /* it flies away from the jet */
    (void)state;
    for (int frame = 0; frame < 300; frame++) {
        struct entities e = steps_rows(&f);
        struct vec3 before = entities_velocity(&e, row);
        fixture_run(&f, 1);
        e = steps_rows(&f);
        if (e.state[row] == ENTITY_FREE)
            break;
        struct vec3 after = entities_velocity(&e, row);
        double cosine = vec3_dot(before, after) / (vec3_length(before) * vec3_length(after));
        assert_true(acos(maths_clamp(cosine, -1.0, 1.0)) <= kind->turn_rate_rps / 60.0 + 1e-7);
        assert_true(vec3_length(after) <= kind->max_speed_mps + 1e-9);
        assert_true(vec3_length(after) >= vec3_length(before) - 1e-9);
    }
}

static void test_a_missile_without_a_target_flies_straight(void **state)
{
    uint32_t jet = fixture_put(&f, (struct fixture_entity){.kind = "jet",
                                                           .at = {25000.0, 900.0, 23000.0},
                                                           .velocity = {200.0, 0.0, 0.0}});
    uint32_t lost =
        put_missile(jet, (struct vec3){20000.0, 800.0, 25000.0}, (struct vec3){0.0, 0.0, -100.0});
    uint32_t never = put_missile(SLOT_NONE, (struct vec3){22000.0, 800.0, 25000.0},
                                 (struct vec3){60.0, 80.0, 0.0});
    (void)state;
    steps_rows(&f).target_id[lost] = 999; /* an id that no row has */
    fixture_run(&f, 120);
    struct entities e = steps_rows(&f);
    assert_true(fabs(e.x[lost] - 20000.0) < 1e-9 && fabs(e.y[lost] - 800.0) < 1e-9);
    assert_true(e.z[lost] < 24600.0);
    /* On the line through its start, direction (3, 4, 0). */
    assert_true(fabs((e.x[never] - 22000.0) * 4.0 - (e.y[never] - 800.0) * 3.0) < 1e-6);
    assert_true(e.y[never] > 1000.0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_ballistic_round_follows_the_parabola),
        TEST(test_the_parabola_does_not_depend_on_the_frame_rate),
        TEST(test_a_sabot_round_is_as_fast_as_published),
        TEST(test_a_howitzer_reaches_what_is_published),
        TEST(test_a_round_ends_in_the_air_when_its_life_is_over),
        TEST(test_a_missile_reaches_a_crossing_jet),
        TEST(test_what_leaves_the_seekers_cone_is_lost_for_good),
        TEST(test_missiles_meet_targets_that_turn_away),
        TEST(test_a_missile_turns_and_gains_speed_within_its_means),
        TEST(test_a_missile_without_a_target_flies_straight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
