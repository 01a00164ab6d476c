/* Rectangles in the way of a vehicle. */
#include "mover/agent/driving/seen_box.h"

#include "tests/support/fixture.h"
#include "world/maths/maths.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

/* A rectangle of 18 x 12 m, turned by an angle. */
static struct seen_box house(double along, double right, double angle_rad)
{
    double sine, cosine;
    maths_sincos(angle_rad, &sine, &cosine);
    return (struct seen_box){.along = along,
                             .right = right,
                             .length_along = 9.0 * cosine,
                             .length_right = 9.0 * sine,
                             .width_along = -6.0 * sine,
                             .width_right = 6.0 * cosine};
}

static void test_a_wall_ahead_is_as_far_as_its_near_side(void **state)
{
    const struct seen_box box = house(30.0, 0.0, 0.0);
    (void)state;
    assert_true(fabs(seen_box_nearest(&box, -1.0, 1.0) - 21.0) < 1e-12);
}

static void test_a_house_beside_the_way_is_no_obstacle(void **state)
{
    const struct seen_box box = house(30.0, 9.0, 0.0);
    (void)state;
    assert_true(seen_box_nearest(&box, -1.0, 2.9) == INFINITY);
    assert_true(fabs(seen_box_nearest(&box, -1.0, 3.1) - 21.0) < 1e-12);
}

/* Its near end is beside the vehicle, but its wall crosses the way only further on. */
static void test_a_wall_askew_is_as_far_as_it_crosses_the_way(void **state)
{
    const struct seen_box box = house(5.0, -8.0, 0.3);
    (void)state;
    const double at_left = seen_box_nearest(&box, -2.0, 2.0);
    assert_true(at_left > 3.0 && at_left < 5.0);
    assert_true(seen_box_nearest(&box, -1.0, 2.0) > at_left);
}

static void test_what_is_behind_is_no_obstacle(void **state)
{
    struct seen_box box = house(-9.5, 0.0, 0.0);
    (void)state;
    assert_true(seen_box_nearest(&box, -1.0, 1.0) == INFINITY);
    box.along = -8.0; /* it reaches 1 m ahead: the vehicle is in it */
    assert_true(seen_box_nearest(&box, -1.0, 1.0) == 0.0);
}

/* The oracle: the nearest of many points of the rectangle. */
static void test_it_agrees_with_points(void **state)
{
    uint64_t random = fixture_seed(5);
    (void)state;
    for (int round = 0; round < 400; round++) {
        const struct seen_box box =
            house(fixture_uniform(&random, -20.0, 40.0), fixture_uniform(&random, -20.0, 20.0),
                  fixture_uniform(&random, 0.0, TWO_PI));
        const double low = fixture_uniform(&random, -4.0, 0.0), high = low + 3.0;
        double least = INFINITY, farthest = -INFINITY;
        for (int n = 0; n <= 200; n++) {
            for (int k = 0; k <= 200; k++) {
                const double a = 0.01 * n - 1.0, b = 0.01 * k - 1.0;
                const double right = box.right + a * box.length_right + b * box.width_right;
                const double along = box.along + a * box.length_along + b * box.width_along;
                if (right < low || right > high)
                    continue;
                least = maths_min(least, along);
                farthest = maths_max(farthest, along);
            }
        }
        const double found = seen_box_nearest(&box, low, high);
        if (farthest > 0.0)
            assert_true(fabs(found - maths_max(least, 0.0)) < 0.5);
        else if (farthest < -0.5)
            assert_true(found == INFINITY);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_wall_ahead_is_as_far_as_its_near_side),
        cmocka_unit_test(test_a_house_beside_the_way_is_no_obstacle),
        cmocka_unit_test(test_a_wall_askew_is_as_far_as_it_crosses_the_way),
        cmocka_unit_test(test_what_is_behind_is_no_obstacle),
        cmocka_unit_test(test_it_agrees_with_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
