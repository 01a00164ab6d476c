/* Where receivers have a body that was told them. */
#include "world/entity/told_motion.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define EXACT 1e-9
#define FLOAT 1e-6 /* rates are floats */

static void assert_near(double value, double expected, double most)
{
    assert_true(fabs(value - expected) <= most);
}

static void test_without_rates_it_goes_straight_on(void **state)
{
    const struct told_motion told = {.at = {100.0, 5.0, 200.0},
                                     .velocity = {3.0, 1.0, -4.0},
                                     .heading_rad = 2.0,
                                     .turn_rps = 1.0F}; /* for no time */
    (void)state;
    struct told_motion now = told_motion_at(&told, 2.0);
    assert_near(now.at.x, 106.0, EXACT);
    assert_near(now.at.y, 7.0, EXACT);
    assert_near(now.at.z, 192.0, EXACT);
    assert_near(now.heading_rad, 2.0, EXACT);
}

/* A quarter of a circle of 20 m to the right, from north to east, and then straight on to the east.
 */
static void test_it_turns_and_then_goes_straight_on(void **state)
{
    const double quarter_s = 2.0, speed_mps = HALF_PI * 20.0 / quarter_s;
    const struct told_motion told = {.velocity = {0.0, 0.0, -speed_mps},
                                     .turn_rps = (float)(HALF_PI / quarter_s),
                                     .lasts_s = (float)quarter_s};
    (void)state;
    struct told_motion now = told_motion_at(&told, quarter_s);
    assert_near(now.at.x, 20.0, 1e-4); /* of the series of cruise_chord() */
    assert_near(now.at.z, -20.0, 1e-4);
    assert_near(now.heading_rad, HALF_PI, FLOAT);
    assert_near(now.velocity.x, speed_mps, 1e-5);
    now = told_motion_at(&told, quarter_s + 1.0);
    assert_near(now.at.x, 20.0 + speed_mps, 1e-4);
    assert_near(now.at.z, -20.0, 1e-4);
    assert_near(now.heading_rad, HALF_PI, FLOAT);
}

static void test_it_gains_speed_climb_and_attitude(void **state)
{
    const struct told_motion told = {.velocity = {10.0, 2.0, 0.0},
                                     .heading_rad = HALF_PI,
                                     .gain_mps2 = 3.0F,
                                     .climb_mps2 = -1.0F,
                                     .pitch_rps = 0.25F,
                                     .roll_rps = -0.5F,
                                     .lasts_s = 2.0F};
    (void)state;
    struct told_motion now = told_motion_at(&told, 2.0);
    assert_near(now.at.x, 10.0 * 2.0 + 0.5 * 3.0 * 4.0, EXACT);
    assert_near(now.at.y, 2.0 * 2.0 - 0.5 * 4.0, EXACT);
    assert_near(now.velocity.x, 16.0, EXACT);
    assert_near(now.velocity.y, 0.0, EXACT);
    assert_near(now.pitch_rad, 0.5, EXACT);
    assert_near(now.roll_rad, -1.0, EXACT);
    now = told_motion_at(&told, 3.0);
    assert_near(now.at.x, 26.0 + 16.0, EXACT);
    assert_near(now.pitch_rad, 0.5, EXACT);
}

/* In two steps as in one: a receiver may compute from what it computed before. */
static void test_steps_add_up(void **state)
{
    const struct told_motion told = {.velocity = {1.0, 0.0, -12.0}, /* sideways too */
                                     .turn_rps = 0.5F,
                                     .gain_mps2 = 1.0F,
                                     .lasts_s = 1.0F};
    (void)state;
    struct told_motion half = told_motion_at(&told, 0.4), whole = told_motion_at(&told, 1.5);
    half = told_motion_at(&half, 1.1);
    assert_near(half.velocity.x, whole.velocity.x, FLOAT);
    assert_near(half.at.x, whole.at.x, 0.05); /* speed that is gained on a chord */
    assert_near(half.at.z, whole.at.z, 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_without_rates_it_goes_straight_on),
        cmocka_unit_test(test_it_turns_and_then_goes_straight_on),
        cmocka_unit_test(test_it_gains_speed_climb_and_attitude),
        cmocka_unit_test(test_steps_add_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
