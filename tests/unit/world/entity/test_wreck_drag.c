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

/* --- spin --------------------------------------------------------------------------------------*/

/* The torque on strips of the box's sides, added up one by one. */
static double slowing_by_strips(double along_m, double across_m, double rate_rps)
{
    double torque = 0.0, strip = across_m / 10000.0;
    for (double r = 0.5 * (strip - across_m); r < 0.5 * across_m; r += strip)
        torque += 0.5 * 1.225 * 1.05 * along_m * strip * (rate_rps * r) * (rate_rps * r) * fabs(r);
    return torque;
}

static void test_the_air_slows_a_spin(void **state)
{
    (void)state;
    const struct mat3 turn = rotation_matrix(rotation_of(0.0, 0.0, 0.0)); /* x right, y up, -z */
    double moment = 1200.0 * (4.0 * 4.0 + 3.0 * 3.0) / 12.0, dt_s = 1e-6;
    double torque = slowing_by_strips(2.0, 4.0, 10.0) + slowing_by_strips(2.0, 3.0, 10.0);
    struct vec3 spin = wreck_drag_slow_spin(&box, &turn, (struct vec3){0.0, 10.0, 0.0}, dt_s);
    assert_true(fabs((10.0 - spin.y) / dt_s / (torque / moment) - 1.0) < 1e-4);
    assert_true(spin.x == 0.0 && spin.z == 0.0);
    moment = 1200.0 * (2.0 * 2.0 + 3.0 * 3.0) / 12.0; /* about the way that it heads: it rolls */
    torque = slowing_by_strips(4.0, 3.0, 10.0) + slowing_by_strips(4.0, 2.0, 10.0);
    spin = wreck_drag_slow_spin(&box, &turn, (struct vec3){0.0, 0.0, -10.0}, dt_s);
    assert_true(fabs((10.0 + spin.z) / dt_s / (torque / moment) - 1.0) < 1e-4);
}

static void test_a_long_frame_stops_no_spin_and_adds_none(void **state)
{
    (void)state;
    const struct mat3 turn = rotation_matrix(rotation_of(0.3, 0.2, 0.1));
    const struct vec3 begun = {20.0, -10.0, 5.0};
    struct vec3 whole = wreck_drag_slow_spin(&box, &turn, begun, 1.0), spin = begun;
    for (int n = 0; n < 60; n++)
        spin = wreck_drag_slow_spin(&box, &turn, spin, 1.0 / 60.0);
    assert_true(vec3_length(vec3_sub(spin, whole)) < 1e-9);
    assert_true(vec3_length(whole) < vec3_length(begun) && vec3_dot(whole, begun) > 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_side_that_faces_the_wind_counts),
        cmocka_unit_test(test_long_frames_are_as_short_ones),
        cmocka_unit_test(test_nothing_slows_what_stands),
        cmocka_unit_test(test_the_air_slows_a_spin),
        cmocka_unit_test(test_a_long_frame_stops_no_spin_and_adds_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
