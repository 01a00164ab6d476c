/* Where two bodies touch, and a body and the ground: the gaps at the points. */
#include "collider/resting/free_points.h"

#include "collider/motion/body_motion.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

static struct swept_body put(double east_m, double up_m)
{
    uint32_t row = fixture_put(
        &f, (struct fixture_entity){.kind = "tank", .at = {25000.0 + east_m, up_m, 25000.0}});
    struct entities e = steps_rows(&f);
    const struct body_motion *motion = &f.stepper.collider.motion;
    f.stepper.collider.motion.committed = f.stepper.collider.motion.next = &f.view.w[0];
    f.stepper.collider.motion.before = f.view.w[0].entities;
    return body_motion_standing(motion, &e, row);
}

/* The least gap is that of the bodies, and no point is nearer. */
static void test_the_nearest_points_are_among_them(void **state)
{
    struct free_point point[FREE_POINTS_MAX];
    struct swept_body low = put(0.0, 100.0);
    (void)state;
    for (double up = 102.0; up < 104.0; up += 0.01) {
        struct swept_body high = put(0.4, up);
        double gap = time_of_impact_gap(&low, &high, 0.0), least = INFINITY;
        uint32_t count = free_points_find(&low, &high, 0.05, point);
        for (uint32_t i = 0; i < count; i++) {
            least = maths_min(least, point[i].gap_m);
            assert_true(point[i].gap_m <= 0.05);
            assert_true(fabs(vec3_length(point[i].normal) - 1.0) < 1e-9);
        }
        steps_empty(&f);
        low = put(0.0, 100.0);
        if (gap > 0.0)
            assert_true(gap > 0.05 ? count == 0 : count > 0 && fabs(least - gap) < 1e-9);
        else
            assert_true(count > 0 && least < 0.0);
    }
}

static void test_a_flat_body_has_points_all_around_on_the_ground(void **state)
{
    struct free_point point[FREE_POINTS_MAX];
    struct body_points points;
    double least = INFINITY, west = INFINITY, east = -INFINITY;
    (void)state;
    body_points_of(&f.view.world, fixture_kind(&f, "tank"), &points);
    struct vec3 at = {25000.0, 100.01, 25000.0};
    uint32_t count = free_points_on_ground(&f.view.world, NULL, &points, at,
                                           rotation_of(HALF_PI, 0.0, 0.0), 0.02, point);
    assert_true(count >= 4);
    for (uint32_t i = 0; i < count; i++) {
        least = maths_min(least, point[i].gap_m);
        west = maths_min(west, point[i].at.x), east = maths_max(east, point[i].at.x);
        assert_true(point[i].normal.y == 1.0);
    }
    assert_true(fabs(least - 0.01) < 2e-3 && west < 25000.0 - 1.0 && east > 25000.0 + 1.0);
    at.y = 100.1;
    assert_int_equal(free_points_on_ground(&f.view.world, NULL, &points, at,
                                           rotation_of(HALF_PI, 0.0, 0.0), 0.02, point),
                     0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_the_nearest_points_are_among_them, open_world,
                                        close_world),
        cmocka_unit_test_setup_teardown(test_a_flat_body_has_points_all_around_on_the_ground,
                                        open_world, close_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
