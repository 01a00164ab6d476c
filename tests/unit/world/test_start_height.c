/* An aeroplane begins where it is told over level and falling ground, and higher before a slope. */
#include "world/start_height.h"

#include "world/entity/kind.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define SIDE      401
#define SPACING_M 10.0
#define MIDDLE_M  2000.0
#define RIDGE_M   300.0

static float posts[SIDE * SIDE];
static const struct terrain ground = {
    .posts = posts, .side = SIDE, .spacing_m = SPACING_M, .squares = GRIDSQUARES_DEFAULT_INIT};
static const struct kind jet = {.domain = DOMAIN_AIR,
                                .min_speed_mps = 70.0,
                                .max_speed_mps = 277.8,
                                .acceleration_mps2 = 9.0,
                                .climb_rate_mps = 80.0,
                                .max_load = 7.3};

/* Returns the height at which a jet begins east-bound, from_m before a slope that rises or falls by
 * RIDGE_M. */
static double begins(double slope, double from_m, double altitude_m, double speed_mps)
{
    for (uint32_t row = 0; row < SIDE; row++)
        for (uint32_t column = 0; column < SIDE; column++) {
            double east_m = maths_max(column * SPACING_M - MIDDLE_M, 0.0);
            posts[row * SIDE + column] = (float)maths_clamp(slope * east_m, -RIDGE_M, RIDGE_M);
        }
    const struct start_flight flight = {MIDDLE_M - from_m, 2000.0, HALF_PI, speed_mps, altitude_m};
    return start_height(&ground, &jet, &flight);
}

static void test_level_ground_raises_nothing(void **state)
{
    (void)state;
    assert_true(begins(0.0, 0.0, 5.0, 70.0) == 5.0);
    assert_true(begins(0.0, 0.0, 80.0, 200.0) == 80.0);
    assert_true(begins(-1.0, 0.0, 5.0, 70.0) == 5.0); /* it falls away */
}

static void test_a_slope_raises_by_what_the_climb_lacks(void **state)
{
    (void)state;
    double steep = begins(1.0, 0.0, 80.0, 70.0), gentle = begins(0.1, 0.0, 80.0, 70.0);
    double far = begins(1.0, 2000.0, 80.0, 150.0), high = begins(1.0, 0.0, 400.0, 70.0);
    print_message("before 45 degrees at 80 m: begins at %.0f m\n", steep);
    assert_true(steep > 200.0 && steep < RIDGE_M + 20.0);
    assert_true(gentle == 80.0 && far == 80.0 && high == 400.0);
    assert_true(begins(1.0, 500.0, 80.0, 70.0) < steep); /* it has time to climb */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_level_ground_raises_nothing),
        cmocka_unit_test(test_a_slope_raises_by_what_the_climb_lacks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
