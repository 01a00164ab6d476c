/* Ballistic munitions: exact parabolas, and drag as published. */
#include "tests/support/steps.h"
#include "world/world.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

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
        assert_true(fabs(e.row[row].x - (at.x + v.x * t)) < 1e-7);
        assert_true(fabs(e.row[row].z - (at.z + v.z * t)) < 1e-7);
        assert_true(fabs(e.row[row].y - (at.y + v.y * t - 0.5 * GRAVITY_MPS2 * t * t)) < 1e-7);
        assert_true(fabs(e.row[row].vy - (v.y - GRAVITY_MPS2 * t)) < 1e-9);
        assert_true(e.row[row].vx == v.x && e.row[row].vz == v.z);
        assert_true(fabs(e.row[row].pitch - atan2(e.row[row].vy, hypot(v.x, v.z))) < 1e-12);
        assert_true(fabs(e.row[row].heading - atan2(v.x, -v.z)) < 1e-12);
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
    double start = steps_rows(&f).row[row].x, hz = 1.0 / world_dt_s(&f.view.world);
    for (int frame = 0;; frame++) {
        struct entities e = steps_rows(&f);
        if (e.row[row].state == ENTITY_FREE || e.row[row].x - start >= far_m)
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
    assert_int_equal(steps_rows(&f).row[row].state, ENTITY_ACTIVE);
    fixture_run(&f, 1);
    assert_int_equal(steps_rows(&f).row[row].state, ENTITY_FREE);
    const struct event *event = fixture_event(&f, EVENT_DETONATION, 0);
    assert_non_null(event);
    assert_int_equal(event->detonation.struck, STRUCK_AIR);
    assert_int_equal(event->frame, frames);
    assert_int_equal(fixture_state(&f).head->munitions, 0);
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
