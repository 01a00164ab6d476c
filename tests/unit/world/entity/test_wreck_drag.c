/* Drag of the air on wrecks. */
#include "world/entity/wreck_drag.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdint.h>

#include <cmocka.h>

static const struct kind box = {
    .domain = DOMAIN_LAND, .mass_kg = 1200.0, .length_m = 4.0, .height_m = 2.0, .width_m = 3.0};

static double slowed(const struct kind *kind, double pitch, struct vec3 velocity, double dt_s)
{
    const struct mat3 turn = rotation_matrix(rotation_of(0.0, pitch, 0.0)); /* it heads north: -z */
    return vec3_length(wreck_drag_slow(kind, &turn, velocity, dt_s));
}

static bool near(double value, double right)
{
    return fabs(value - right) <= 1e-12 * right;
}

static void test_the_side_that_faces_the_wind_counts(void **state)
{
    (void)state;
    double per_m2 = 0.5 * 1.225 * 1.05 / 1200.0 * 50.0 * 0.1;
    assert_true(
        near(slowed(&box, 0.0, (struct vec3){0.0, 0.0, -50.0}, 0.1), 50.0 / (1.0 + 6.0 * per_m2)));
    assert_true(
        near(slowed(&box, 0.0, (struct vec3){0.0, -50.0, 0.0}, 0.1), 50.0 / (1.0 + 12.0 * per_m2)));
    assert_true(
        near(slowed(&box, 0.0, (struct vec3){-50.0, 0.0, 0.0}, 0.1), 50.0 / (1.0 + 8.0 * per_m2)));
    assert_true(near(slowed(&box, HALF_PI, (struct vec3){0.0, 0.0, -50.0}, 0.1),
                     50.0 / (1.0 + 12.0 * per_m2)));
}

static void test_long_frames_are_as_short_ones(void **state)
{
    (void)state;
    struct vec3 v = {0.0, -200.0, -100.0};
    const struct mat3 turn = rotation_matrix(rotation_of(0.3, 0.2, 0.1));
    struct vec3 whole = wreck_drag_slow(&box, &turn, v, 1.0);
    for (int n = 0; n < 60; n++)
        v = wreck_drag_slow(&box, &turn, v, 1.0 / 60.0);
    assert_true(vec3_length(vec3_sub(v, whole)) < 1e-9);
    assert_true(vec3_length(wreck_drag_slow(&box, &turn, v, 1e9)) < 1e-3);
}

static void test_nothing_slows_what_stands(void **state)
{
    (void)state;
    assert_true(slowed(&box, 0.0, (struct vec3){0.0, 0.0, 0.0}, 1.0) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_side_that_faces_the_wind_counts),
        cmocka_unit_test(test_long_frames_are_as_short_ones),
        cmocka_unit_test(test_nothing_slows_what_stands),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
