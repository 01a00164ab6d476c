/* Haines's crossings on polygons that can be drawn. Random ones:
 * tests/property/collider/geometry/test_point_in_polygon.c. */
#include "collider/geometry/point_in_polygon.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static const struct vec3 up = {0, 1, 0};

static void test_row_22_inside_a_square_and_out_of_it(void **state)
{
    const struct vec3 square[] = {{0, 5, 0}, {0, 5, 4}, {4, 5, 4}, {4, 5, 0}};
    (void)state;
    assert_true(point_in_polygon_inside(square, 4, up, (struct vec3){1, 5, 3}));
    assert_true(
        point_in_polygon_inside(square, 4, (struct vec3){0, -1, 0}, (struct vec3){3.9, 5, 0.1}));
    assert_false(point_in_polygon_inside(square, 4, up, (struct vec3){-1, 5, 3}));
    assert_false(point_in_polygon_inside(square, 4, up, (struct vec3){1, 5, 7}));
    assert_false(point_in_polygon_inside(square, 4, up, (struct vec3){5, 5, 2}));
    assert_false(point_in_polygon_inside(square, 4, up, (struct vec3){1, 5, -0.1}));
}

/* What the figure, printed without its guard, gets wrong: edges that lie wholly above the axis. */
static void test_row_22_edges_that_do_not_cross_the_axis_do_not_count(void **state)
{
    const struct vec3 notched[] = {{1, 0, 1}, {2, 0, 2}, {3, 0, 1}, {3, 0, 4}, {1, 0, 4}};
    (void)state;
    assert_false(point_in_polygon_inside(notched, 5, up, (struct vec3){2, 0, 1.5}));
    assert_true(point_in_polygon_inside(notched, 5, up, (struct vec3){2, 0, 2.5}));
    assert_false(point_in_polygon_inside(notched, 5, up, (struct vec3){0, 0, 0}));
}

static void test_row_22_it_projects_along_the_dominant_axis(void **state)
{
    const struct vec3 wall[] = {{3, 0, 0}, {3, 2, 0}, {3, 2, 2}, {3, 0, 2}};
    const struct vec3 slope[] = {{0, 0, 0}, {2, 1, 0}, {2, 1, 2}, {0, 0, 2}};
    (void)state;
    assert_true(point_in_polygon_inside(wall, 4, (struct vec3){1, 0, 0}, (struct vec3){3, 1, 1}));
    assert_false(point_in_polygon_inside(wall, 4, (struct vec3){-1, 0, 0}, (struct vec3){3, 3, 1}));
    assert_true(
        point_in_polygon_inside(slope, 4, (struct vec3){-1, 2, 0}, (struct vec3){1, 0.5, 1}));
    assert_false(
        point_in_polygon_inside(slope, 4, (struct vec3){-1, 2, 0}, (struct vec3){3, 1.5, 1}));
}

static void test_row_22_a_shared_edge_and_its_ends_belong_to_one(void **state)
{
    const struct vec3 left[] = {{0, 0, 0}, {3, 0, 0}, {1, 0, 3}};
    const struct vec3 right[] = {{3, 0, 0}, {4, 0, 3}, {1, 0, 3}};
    (void)state;
    for (int i = 1; i < 30; i++) {
        double t = i / 30.0; /* on the edge from (3, 0) to (1, 3), as near as doubles come */
        struct vec3 p = {3.0 - 2.0 * t, 0, 3.0 * t};
        assert_true(point_in_polygon_inside(left, 3, up, p) !=
                    point_in_polygon_inside(right, 3, up, p));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_22_inside_a_square_and_out_of_it),
        cmocka_unit_test(test_row_22_edges_that_do_not_cross_the_axis_do_not_count),
        cmocka_unit_test(test_row_22_it_projects_along_the_dominant_axis),
        cmocka_unit_test(test_row_22_a_shared_edge_and_its_ends_belong_to_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
