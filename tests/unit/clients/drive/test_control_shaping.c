/* Control shaping: dead zone and curve, the time of keys, the lever, gears. */
#include "clients/drive/control_shaping.c" /* the unit tests are not linked with the processes */

#include "tests/support/fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define MS 1000000u
#define T0 (5000 * (uint64_t)MS)

static struct control_shaping shaping;

static int reset_shaping(void **state)
{
    (void)state;
    control_shaping_reset(&shaping, T0);
    return 0;
}

static void give(enum intent_type type, enum input_axis axis, double value, bool reports_release,
                 uint64_t at)
{
    struct intent intent = {
        .type = type, .axis = axis, .value = (float)value, .reports_release = reports_release};
    control_shaping_apply(&shaping, &intent, at);
}

/* Steps by 10 ms up to the time, as a session does. */
static struct controls run_to(uint64_t end)
{
    while (shaping.step_ns < end)
        (void)control_shaping_step(
            &shaping, shaping.step_ns + 10 * MS < end ? shaping.step_ns + 10 * MS : end);
    return control_shaping_controls(&shaping, false);
}

static void test_curve(void **state)
{
    (void)state;
    assert_true(control_shaping_shape(0.0) == 0.0 &&
                control_shaping_shape(CONTROL_SHAPING_DEAD) == 0.0);
    assert_true(control_shaping_shape(CONTROL_SHAPING_DEAD + 0.01) > 0.0);
    assert_true(fabs(control_shaping_shape(1.0) - 1.0) < 1e-12 &&
                fabs(control_shaping_shape(-7.0) + 1.0) < 1e-12);
    assert_true(control_shaping_shape((double)NAN) == 0.0);
    uint64_t seed = fixture_seed(11);
    for (int i = 0; i < 1000; i++) { /* odd, and never falling */
        double a = fixture_uniform(&seed, -1.2, 1.2), b = fixture_uniform(&seed, -1.2, 1.2);
        assert_true(fabs(control_shaping_shape(a) + control_shaping_shape(-a)) < 1e-12);
        assert_true(a > b || control_shaping_shape(a) <= control_shaping_shape(b));
    }
}

/* Row 11: twice the push is more than twice the change; twice the time too. */
static void test_more_pressure_is_faster(void **state)
{
    (void)state;
    give(INTENT_RATE, AXIS_THROTTLE, 0.4, false, T0);
    double soft = (double)run_to(T0 + 200 * MS).throttle;
    (void)reset_shaping(NULL);
    give(INTENT_RATE, AXIS_THROTTLE, 0.8, false, T0);
    double hard = (double)run_to(T0 + 200 * MS).throttle;
    assert_true(soft > 0.0 && hard > 2.0 * soft);

    (void)reset_shaping(NULL);
    give(INTENT_DOWN, AXIS_THROTTLE, 1.0, true, T0);
    double first = (double)run_to(T0 + 200 * MS).throttle;
    double then = (double)run_to(T0 + 400 * MS).throttle - first;
    first -= LEVER_KICK;
    assert_true(first > 0.0 && then > 1.5 * first);
}

static void test_tap_counts_at_once(void **state)
{
    (void)state;
    give(INTENT_DOWN, AXIS_STEER, -1.0, false, T0);
    assert_true(fabs((double)control_shaping_controls(&shaping, false).steer + KEY_KICK) < 1e-6);
    give(INTENT_DOWN, AXIS_THROTTLE, 1.0, false, T0);
    assert_true(fabs((double)control_shaping_controls(&shaping, false).throttle - LEVER_KICK) <
                1e-6);
}

/* Without releases a press is a pulse, repeats hold it, and it centres itself. */
static void test_pulses(void **state)
{
    (void)state;
    give(INTENT_DOWN, AXIS_STEER, 1.0, false, T0);
    assert_true(run_to(T0 + 150 * MS).steer > (float)KEY_KICK);
    assert_true(run_to(T0 + 900 * MS).steer == 0.0f);
    give(INTENT_DOWN, AXIS_STEER, 1.0, false, T0 + 900 * MS);
    for (uint64_t at = 900; at < 2000; at += 50) {
        give(INTENT_DOWN, AXIS_STEER, 1.0, false, T0 + at * MS);
        (void)run_to(T0 + (at + 50) * MS);
    }
    assert_true(control_shaping_controls(&shaping, false).steer == 1.0f);
    assert_true(run_to(T0 + 3000 * MS).steer == 0.0f);
}

static void test_releases(void **state)
{
    (void)state;
    give(INTENT_DOWN, AXIS_STEER, 1.0, true, T0);
    assert_true(run_to(T0 + 2000 * MS).steer == 1.0f); /* no repeat is needed */
    give(INTENT_UP, AXIS_STEER, 1.0, true, T0 + 2000 * MS);
    assert_true(run_to(T0 + 2100 * MS).steer < 0.6f);
    assert_true(run_to(T0 + 2300 * MS).steer == 0.0f);
    give(INTENT_DOWN, AXIS_STEER, -1.0, true, T0 + 2300 * MS);
    give(INTENT_UP, AXIS_STEER, 1.0, true, T0 + 2310 * MS); /* the other key's */
    assert_true(run_to(T0 + 2500 * MS).steer < -0.3f);
}

/* The lever stays; pulled back it stops at nothing, and the next press goes on backwards. */
static void test_lever(void **state)
{
    (void)state;
    give(INTENT_DOWN, AXIS_THROTTLE, 1.0, true, T0);
    give(INTENT_UP, AXIS_THROTTLE, 1.0, true, T0 + 100 * MS);
    float left = run_to(T0 + 500 * MS).throttle;
    assert_true(left > 0.0f && run_to(T0 + 5000 * MS).throttle == left);
    give(INTENT_DOWN, AXIS_THROTTLE, -1.0, true, T0 + 5000 * MS);
    assert_true(run_to(T0 + 9000 * MS).throttle == 0.0f);
    give(INTENT_UP, AXIS_THROTTLE, -1.0, true, T0 + 9000 * MS);
    give(INTENT_DOWN, AXIS_THROTTLE, -1.0, true, T0 + 9100 * MS);
    assert_true(run_to(T0 + 9500 * MS).throttle < -0.1f);
    control_shaping_stop(&shaping);
    assert_true(run_to(T0 + 9900 * MS).throttle == 0.0f);
}

static void test_brake_ends_the_throttle(void **state)
{
    (void)state;
    give(INTENT_SET, AXIS_THROTTLE, 1.0, false, T0);
    assert_true(run_to(T0 + 50 * MS).throttle == 1.0f);
    give(INTENT_DOWN, AXIS_BRAKE, 1.0, true, T0 + 50 * MS);
    struct controls controls = run_to(T0 + 1000 * MS);
    assert_true(controls.brake == 1.0f && controls.throttle == 0.0f);
    give(INTENT_UP, AXIS_BRAKE, 1.0, true, T0 + 1000 * MS);
    assert_true(run_to(T0 + 2000 * MS).brake == 0.0f);
}

static void test_gears(void **state)
{
    (void)state;
    control_shaping_gear(&shaping, 1);
    assert_int_equal(shaping.gear, GEAR_AUTOMATIC); /* the last there is */
    control_shaping_gear(&shaping, -1);
    assert_int_equal(shaping.gear, GEAR_LOW);
    control_shaping_gear(&shaping, -1);
    assert_int_equal(shaping.gear, GEAR_NEUTRAL);
    control_shaping_gear(&shaping, -1);
    control_shaping_gear(&shaping, -1);
    assert_int_equal(shaping.gear, GEAR_REVERSE);
}

static void test_aim_is_an_aircrafts_stick(void **state)
{
    (void)state;
    give(INTENT_SET, AXIS_AIM_X, 1.0, false, T0);
    give(INTENT_SET, AXIS_AIM_Y, -1.0, false, T0);
    struct controls land = control_shaping_controls(&shaping, false),
                    air = control_shaping_controls(&shaping, true);
    assert_true(land.traverse == 1.0f && land.elevate == -1.0f && land.steer == 0.0f);
    assert_true(air.steer == 1.0f && air.climb == -1.0f && air.traverse == 0.0f);
    assert_true(control_shaping_aims(&shaping));
}

/* Whatever comes, controls are in their ranges: the mover refuses others. */
static void test_ranges(void **state)
{
    (void)state;
    uint64_t seed = fixture_seed(12), now_ns = T0;
    for (int i = 0; i < 20000; i++) {
        enum intent_type type = (enum intent_type)(fixture_random(&seed) % INTENT_ACT);
        enum input_axis axis = (enum input_axis)(fixture_random(&seed) % AXIS_COUNT);
        now_ns += fixture_random(&seed) % (50 * MS);
        give(type, axis, fixture_uniform(&seed, -1.5, 1.5), fixture_random(&seed) & 1, now_ns);
        (void)control_shaping_step(&shaping, now_ns);
        struct controls c = control_shaping_controls(&shaping, i & 1);
        const float all[] = {c.throttle, c.steer, c.climb, c.traverse, c.elevate};
        for (int k = 0; k < 5; k++)
            assert_true(all[k] >= -1.0f && all[k] <= 1.0f);
        assert_true(c.brake >= 0.0f && c.brake <= 1.0f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_curve, reset_shaping),
        cmocka_unit_test_setup(test_more_pressure_is_faster, reset_shaping),
        cmocka_unit_test_setup(test_tap_counts_at_once, reset_shaping),
        cmocka_unit_test_setup(test_pulses, reset_shaping),
        cmocka_unit_test_setup(test_releases, reset_shaping),
        cmocka_unit_test_setup(test_lever, reset_shaping),
        cmocka_unit_test_setup(test_brake_ends_the_throttle, reset_shaping),
        cmocka_unit_test_setup(test_gears, reset_shaping),
        cmocka_unit_test_setup(test_aim_is_an_aircrafts_stick, reset_shaping),
        cmocka_unit_test_setup(test_ranges, reset_shaping),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
