/* The lift of a wing at a speed, and how hard crews rely on pulling up and braking. */
#include "world/entity/climb_limits.h"

#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static const struct kind jet = {.domain = DOMAIN_AIR, .min_speed_mps = 70.0, .max_load = 7.3};
static const struct kind helicopter = {.domain = DOMAIN_AIR};

static void test_lift_grows_with_the_square_of_the_speed(void **state)
{
    (void)state;
    assert_true(climb_limits_lift(&jet, 70.0) == 1.0);
    assert_true(climb_limits_lift(&jet, 140.0) == 4.0);
    assert_true(climb_limits_lift(&jet, 280.0) == 7.3); /* what its frame bears */
}

static void test_a_wing_pulls_up_by_what_its_weight_leaves(void **state)
{
    (void)state;
    double stall = climb_limits_pull(&jet, 70.0), slow = climb_limits_pull(&jet, 91.0);
    double fast = climb_limits_pull(&jet, 140.0);
    assert_true(stall > 0.0 && stall < 0.1 * GRAVITY_MPS2);
    assert_true(fabs(slow - 0.65 * (1.69 - 1.0) * GRAVITY_MPS2) < 1e-9);
    assert_true(fabs(fast - 0.65 * CLIMB_LIMITS_PULL * GRAVITY_MPS2) < 1e-9);
    assert_true(fast == climb_limits_pull(&jet, 200.0));
}

static void test_a_helicopter_needs_no_speed(void **state)
{
    (void)state;
    assert_true(climb_limits_pull(&helicopter, 0.0) == climb_limits_pull(&helicopter, 70.0));
    assert_true(climb_limits_pull(&helicopter, 0.0) > 0.3 * GRAVITY_MPS2);
    assert_true(climb_limits_brake(&helicopter) > 10.0 * climb_limits_brake(&jet));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lift_grows_with_the_square_of_the_speed),
        cmocka_unit_test(test_a_wing_pulls_up_by_what_its_weight_leaves),
        cmocka_unit_test(test_a_helicopter_needs_no_speed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
