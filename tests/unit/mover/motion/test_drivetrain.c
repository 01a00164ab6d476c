/* Forces of engine and brakes, and the steering wheel. */
#include "mover/motion/drivetrain.h"

#include "world/entity/kind.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const struct kind kind = {.mass_kg = 1000.0,
                                 .power_w = 50e3,
                                 .acceleration_mps2 = 3.0,
                                 .max_speed_mps = 30.0,
                                 .width_m = 1.6,
                                 .height_m = 1.7,
                                 .least_turn_m = 5.0,
                                 .turn_rate_rps = 1.0,
                                 .track_m = 1.4,
                                 .centre_height_m = 0.7};
static const struct drivetrain_ground level = {0.0, 6000.0, 400.0};

static struct drivetrain asked(double mps, double brake)
{
    return (struct drivetrain){.kind = &kind, .wanted_mps = mps, .slowing = brake, .driven = true};
}

static void test_power_limits_the_drive_at_speed(void **state)
{
    struct drivetrain full = asked(30.0, 0.0);
    (void)state;
    double resists = 400.0 + 0.48 * 1.6 * 1.7 * 20.0 * 20.0, all = 0.7 * 50e3 / 20.0;
    double gains = drivetrain_force(&full, 20.0, &level).drive_n - resists;
    assert_true(fabs(gains - (all - resists) / drivetrain_gears(&kind)) < 1e-9);
    const struct drivetrain_ground steep = {0.3, 6000.0, 400.0}; /* all power against the slope */
    assert_true(fabs(drivetrain_force(&full, 20.0, &steep).drive_n - all) < 1e-9);
    assert_true(drivetrain_force(&full, 1.0, &level).drive_n <= level.grip_n);
    assert_true(drivetrain_force(&full, 1.0, &level).drive_n > 3000.0);
}

static void test_engine_brakes_and_pedal_add_to_rolling(void **state)
{
    struct drivetrain released = asked(0.0, 0.0), pedal = asked(0.0, 1.0);
    (void)state;
    assert_true(fabs(drivetrain_force(&released, 20.0, &level).brake_n - 400.0 - 1500.0) < 1e-9);
    assert_true(fabs(drivetrain_force(&pedal, 20.0, &level).brake_n - 6000.0) < 1e-9);
    struct drivetrain_ground down = {-0.5, 6000.0, 400.0}; /* steeper than the engine holds */
    assert_true(fabs(drivetrain_force(&released, 20.0, &down).brake_n - 400.0 - 1500.0) < 1e-9);
    assert_true(drivetrain_force(&released, 31.0, &down).brake_n > 5000.0); /* too fast */
}

static void test_neutral_drives_nothing(void **state)
{
    struct drivetrain neutral = asked(30.0, 0.0);
    (void)state;
    neutral.neutral = true;
    struct drivetrain_force force = drivetrain_force(&neutral, 5.0, &level);
    assert_true(force.drive_n == 0.0 && force.brake_n == 400.0);
}

static void test_the_wheel_turns_at_its_rate(void **state)
{
    struct drivetrain driver = asked(5.0, 0.0), agent = asked(5.0, 0.0);
    (void)state;
    driver.turn = 1.0;
    drivetrain_steer(&driver, 2.0, 0.65, 0.1);
    assert_true(fabs(driver.wheel - 0.2) < 1e-12 && fabs(driver.curve - 0.2 / 5.0) < 1e-12);
    for (int n = 0; n < 10; n++)
        drivetrain_steer(&driver, 2.0, 0.65, 0.1);
    assert_true(driver.wheel == 1.0 && fabs(driver.curve - 0.2) < 1e-12);
    agent.driven = false;
    agent.asked_rps = 1.0;
    drivetrain_steer(&agent, 20.0, 0.65, 0.1); /* no harder than the ground holds */
    assert_true(agent.curve * 20.0 * 20.0 <= drivetrain_lateral(&kind, 0.65) + 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_power_limits_the_drive_at_speed),
        cmocka_unit_test(test_engine_brakes_and_pedal_add_to_rolling),
        cmocka_unit_test(test_neutral_drives_nothing),
        cmocka_unit_test(test_the_wheel_turns_at_its_rate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
