/* The points of a body that can touch the ground, and their height over it. */
#include "tests/support/steps.h"
#include "world/body_points.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static double clearance(const struct fixture *f, const char *kind, double y, double roll)
{
    struct body_points points;
    body_points_of(&f->view.world, fixture_kind(f, kind), &points);
    return body_points_clearance(&f->view.world, NULL, &points, (struct vec3){25000.0, y, 25000.0},
                                 rotation_of(0.7, 0.0, roll));
}

static void test_spheres_touch_the_ground_with_their_kinds_box(void **state)
{
    struct fixture f;
    struct body_points points;
    (void)state;
    fixture_open(&f, "");
    body_points_of(&f.view.world, fixture_kind(&f, "jet"), &points);
    assert_int_equal(points.count, BODY_POINTS_BOX);
    for (uint32_t i = 0; i < points.count; i++)
        assert_true(vec3_length(points.point[i]) <= points.reach_m + 1e-9);
    /* A vehicle stands on its position, an aircraft is about it. */
    assert_true(fabs(clearance(&f, "tank", 103.0, 0.0) - 3.0) < 1e-9);
    assert_true(fabs(clearance(&f, "jet", 103.0, 0.0) - (3.0 - 1.8)) < 1e-9);
    assert_true(fabs(clearance(&f, "jet", 103.0, HALF_PI) - (3.0 - 5.15)) < 1e-9);
    fixture_close(&f);
}

static void test_models_touch_it_with_their_outer_hull(void **state)
{
    struct fixture f;
    struct body_points points;
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    const struct kind *jet = steps_kind(&f, "jet");
    body_points_of(&f.view.world, fixture_kind(&f, "jet"), &points);
    assert_true(points.count > BODY_POINTS_BOX && points.reach_m == jet->bound_m);
    for (uint32_t i = 0; i < points.count; i++)
        assert_true(vec3_length(points.point[i]) <= points.reach_m + 1e-9);
    assert_true(fabs(clearance(&f, "jet", 103.0, 0.0) - (3.0 + jet->low_m)) < 1e-9);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spheres_touch_the_ground_with_their_kinds_box),
        cmocka_unit_test(test_models_touch_it_with_their_outer_hull),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
