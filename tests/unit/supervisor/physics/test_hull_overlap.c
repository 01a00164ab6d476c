/* Overlap of boxes by known amounts. */
#include "supervisor/physics/hull_overlap.h"

#include "tests/support/fixture.h"
#include "world/entity/hull.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const struct vec3 corners[] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                      {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
static const struct hull cube = {.vertex_count = 8, .radius_m = 1.7320508075688774};
static const struct world world = {.hull_vertices = corners};

static struct hull_shape shape;

static int find_cube(void **state)
{
    (void)state;
    return hull_shape_find(&shape, &world, &cube);
}

static int free_cube(void **state)
{
    (void)state;
    hull_shape_free(&shape);
    return 0;
}

/* Two cubes of 2 m far from the origin; heading of the first is east, so that x is its front. */
static double apart(double x, double y, double z, double heading, double scale)
{
    const struct rigid_pose a =
        rigid_pose_of((struct vec3){25000.0, 100.0, 30000.0}, HALF_PI, 0, 0);
    const struct rigid_pose b =
        rigid_pose_of((struct vec3){25000.0 + x, 100.0 + y, 30000.0 + z}, heading, 0, 0);
    const struct relative_place place = hull_overlap_place(&a, &b, scale);
    struct vec3 axis = {0.0, 0.0, 0.0};
    return hull_overlap_find(&shape, &shape, &place, 100.0, &axis);
}

static void is(double value, double wanted)
{
    if (fabs(value - wanted) > 1e-9)
        fail_msg("%.12g instead of %.12g", value, wanted);
}

static void test_a_cube_has_six_faces_and_twelve_edges(void **state)
{
    (void)state;
    assert_int_equal(shape.faces, 6);
    assert_int_equal(shape.edges, 12);
}

static void test_depth_is_along_the_shallowest_axis(void **state)
{
    (void)state;
    is(apart(1.7, 0.5, 0.4, HALF_PI, 1.0), -0.3);
    is(apart(0.5, -1.9, 0.4, 0.0, 1.0), -0.1);
    is(apart(0.0, 0.0, 0.0, HALF_PI, 1.0), -2.0);
    is(apart(1.2, 0.0, 0.0, HALF_PI, 0.5), -0.3); /* the second cube is half as large */
}

static void test_separation_is_that_of_faces(void **state)
{
    (void)state;
    is(apart(2.25, 0.5, 0.4, HALF_PI, 1.0), 0.25);
    is(apart(0.5, -2.5, 0.4, HALF_PI, 1.0), 0.5);
    is(apart(2.4142135623730951 + 0.1, 0.0, 0.0, PI / 4.0, 1.0), 0.1); /* an edge to a face */
}

/* Two edges across each other: one cube stands on an edge, the other one lies below it on another
 * edge. No face separates them, and no face's axis is the shallowest. */
static void test_edges_that_cross(void **state)
{
    const struct vec3 at = {25000.0, 100.0, 30000.0};
    struct vec3 above = at, axis = {0.0, 0.0, 0.0};
    (void)state;
    for (int i = -1; i <= 1; i += 2) {
        above.y = at.y + 2.0 * 1.4142135623730951 + 0.05 * i;
        const struct rigid_pose a = rigid_pose_of(at, 0.0, 0.0, PI / 4.0);
        const struct rigid_pose b = rigid_pose_of(above, HALF_PI, 0.0, PI / 4.0);
        const struct relative_place place = hull_overlap_place(&a, &b, 1.0);
        axis = (struct vec3){0.0, 0.0, 0.0};
        is(hull_overlap_find(&shape, &shape, &place, 100.0, &axis), 0.05 * i);
        assert_true(rigid_pose_out(&a, axis).y > 1.0 - 1e-9);
    }
}

static void test_far_hulls_are_far(void **state)
{
    const struct rigid_pose a = rigid_pose_of((struct vec3){0.0, 0.0, 0.0}, 0.0, 0.0, 0.0);
    struct rigid_pose b = a;
    struct vec3 axis = {0.0, 0.0, 0.0};
    (void)state;
    b.at.x = 2.2;
    struct relative_place place = hull_overlap_place(&a, &b, 1.0);
    assert_true(hull_overlap_far(&shape, &shape, &place, 0.1, &axis));
    assert_false(hull_overlap_far(&shape, &shape, &place, 0.3, &axis));
    b.at.x = 1000.0;
    place = hull_overlap_place(&a, &b, 1.0);
    assert_true(hull_overlap_far(&shape, &shape, &place, 0.1, &axis));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_cube_has_six_faces_and_twelve_edges),
        cmocka_unit_test(test_depth_is_along_the_shallowest_axis),
        cmocka_unit_test(test_separation_is_that_of_faces),
        cmocka_unit_test(test_edges_that_cross),
        cmocka_unit_test(test_far_hulls_are_far),
    };
    return cmocka_run_group_tests(tests, find_cube, free_cube);
}
