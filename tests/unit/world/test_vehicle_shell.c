/* The points of a vehicle's shell, and their depth in the ground. */
#include "world/vehicle_shell.h"

#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;

static int open_world(void **state)
{
    *state = &f;
    fixture_open(&f, "earthworks = ( { shape = \"table\"; at = [25000.0, 25000.0];"
                     " length_m = 4.0; width_m = 8.0; height_m = 1.5; edge_m = 0.25; },"
                     " { shape = \"table\"; at = [25050.0, 25000.0];"
                     " length_m = 1.0; width_m = 8.0; height_m = 1.5; edge_m = 0.2; } );");
    return 0;
}

static double depth(const char *kind, uint32_t points, struct vec3 at)
{
    const struct mat3 turn = rotation_matrix(rotation_of(0.0, 0.0, 0.0));
    return vehicle_shell_depth(&f.view.world.terrain, NULL, steps_kind(&f, kind), points, at,
                               &turn);
}

static void test_points_come_in_pairs_within_reach(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "truck"};
    (void)state;
    for (int k = 0; k < 4; k++) {
        const struct kind *kind = steps_kind(&f, kinds[k]);
        for (uint32_t n = 0; n < VEHICLE_SHELL_POINTS; n++) {
            struct vec3 point = vehicle_shell_point(kind, n);
            struct vec3 behind = vehicle_shell_point(kind, n ^ 1u);
            assert_true(point.x == -behind.x && point.y == behind.y && point.z == behind.z);
            assert_true(point.y >= kind->travel_m && point.y <= kind->height_m);
            assert_true(vec3_length(point) <= vehicle_shell_reach(kind));
        }
    }
}

static void test_the_deepest_point_counts(void **state)
{
    const double under = vehicle_shell_point(steps_kind(&f, "jeep"), 0).y;
    (void)state;
    assert_true(fabs(depth("jeep", VEHICLE_SHELL_POINTS, (struct vec3){25100.0, 100.0, 25000.0}) +
                     under) < 1e-9);
    assert_true(fabs(depth("jeep", VEHICLE_SHELL_POINTS, (struct vec3){25000.0, 100.5, 25000.0}) -
                     (1.0 - under)) < 1e-9);
}

/* A bank beside the front wheels of a tank is behind its nose and before its belly. */
static void test_ends_alone_know_nothing_of_the_sides(void **state)
{
    const struct kind *tank = steps_kind(&f, "tank");
    const struct vec3 before = {25000.0, 100.0, 25002.0 + 0.36 * tank->length_m};
    const struct vec3 beside = {25046.2 - 0.5 * tank->width_m, 100.0,
                                25000.0 + 0.29 * tank->length_m};
    (void)state;
    assert_true(depth("tank", VEHICLE_SHELL_ENDS, before) > 0.0);
    assert_true(depth("tank", VEHICLE_SHELL_ENDS, beside) < 0.0);
    assert_true(depth("tank", VEHICLE_SHELL_POINTS, beside) > 0.5);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, fixture_teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_points_come_in_pairs_within_reach),
        TEST(test_the_deepest_point_counts),
        TEST(test_ends_alone_know_nothing_of_the_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
