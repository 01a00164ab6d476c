/* Distances between convex bodies on cases that can be worked out by hand. The random ones are in
 * tests/property/collider/geometry/test_gjk.c. */
#include "collider/geometry/gjk.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static const struct vec3 cube[8] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                    {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
static const struct vec3 origin[1] = {{0, 0, 0}};
static const struct mat3 upright = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static struct convex body(const struct vec3 *vertex, uint32_t count, struct vec3 at)
{
    return (struct convex){vertex, count, 1.0, upright, at};
}

static struct convex cube_at(double x, double y, double z)
{
    return body(cube, 8, (struct vec3){x, y, z});
}

static bool near(struct vec3 a, struct vec3 b, double slack)
{
    return vec3_length(vec3_sub(a, b)) <= slack;
}

static void test_cubes_face_to_face(void **state)
{
    struct convex a = cube_at(0, 0, 0), b = cube_at(5, 0.3, 0.2);
    struct gjk gjk = gjk_distance(&a, &b);
    (void)state;
    assert_true(fabs(gjk.distance_m - 3.0) < 1e-15);
    assert_true(near(gjk.normal, (struct vec3){1, 0, 0}, 1e-15));
    assert_true(fabs(gjk.on_a.x - 1.0) < 1e-15 && fabs(gjk.on_b.x - 4.0) < 1e-15);
    assert_true(near(gjk.on_b, vec3_add(gjk.on_a, (struct vec3){3, 0, 0}), 1e-14));
}

static void test_cubes_corner_to_corner(void **state)
{
    struct convex a = cube_at(0, 0, 0), b = cube_at(4, 5, -8);
    struct gjk gjk = gjk_distance(&a, &b);
    (void)state;
    assert_true(fabs(gjk.distance_m - 7.0) < 1e-14); /* 2, 3, 6 */
    assert_true(near(gjk.on_a, (struct vec3){1, 1, -1}, 1e-15));
    assert_true(near(gjk.on_b, (struct vec3){3, 4, -7}, 1e-15));
}

static void test_edges_that_cross(void **state)
{
    const struct vec3 rod_x[2] = {{-1, 0, 0}, {1, 0, 0}}, rod_z[2] = {{0, 0, -1}, {0, 0, 1}};
    struct convex a = body(rod_x, 2, (struct vec3){0, 0, 0});
    struct convex b = body(rod_z, 2, (struct vec3){0.5, -2.0, 0.25});
    struct gjk gjk = gjk_distance(&a, &b);
    (void)state;
    assert_true(fabs(gjk.distance_m - 2.0) < 1e-15);
    assert_true(near(gjk.normal, (struct vec3){0, -1, 0}, 1e-15));
    assert_true(near(gjk.on_a, (struct vec3){0.5, 0, 0}, 1e-15));
}

static void test_points_and_what_they_touch(void **state)
{
    struct convex a = body(origin, 1, (struct vec3){3, 4, 0}), b = cube_at(0, 0, 0);
    struct convex same = body(origin, 1, (struct vec3){3, 4, 0});
    struct convex on_face = body(origin, 1, (struct vec3){0.5, 1, 0.5});
    struct convex inside = body(origin, 1, (struct vec3){0.5, 0.9, 0.5});
    (void)state;
    assert_true(fabs(gjk_distance(&a, &b).distance_m - sqrt(13.0)) < 1e-15);
    assert_true(gjk_distance(&a, &same).distance_m == 0.0);
    assert_true(gjk_distance(&on_face, &b).distance_m == 0.0);
    assert_true(gjk_distance(&inside, &b).distance_m == 0.0);
}

static void test_bodies_that_overlap_share_a_point_and_have_no_normal(void **state)
{
    struct convex a = cube_at(40000, 0, 40000), b = cube_at(40001.5, 1.5, 40001.5);
    struct gjk gjk = gjk_distance(&a, &b);
    (void)state;
    assert_true(gjk.distance_m == 0.0 && vec3_length(gjk.normal) == 0.0);
    assert_true(near(gjk.on_a, gjk.on_b, 0.0));
    assert_true(gjk.on_a.x > 40000.5 - 1e-9 && gjk.on_a.x < 40001.0 + 1e-9);
    assert_true(gjk.on_a.y > 0.5 - 1e-9 && gjk.on_a.y < 1.0 + 1e-9);
}

static void test_coincident_bodies_overlap(void **state)
{
    struct convex a = cube_at(7, 7, 7);
    (void)state;
    assert_true(gjk_distance(&a, &a).distance_m == 0.0);
}

static void test_scale_and_turn_count(void **state)
{
    struct convex a = cube_at(0, 0, 0), b = cube_at(10, 0, 0);
    (void)state;
    b.scale = 2.0;
    b.turn = rotation_matrix(rotation_of(0.25 * PI, 0.0, 0.0)); /* an edge points at a */
    assert_true(fabs(gjk_distance(&a, &b).distance_m - (9.0 - 2.0 * sqrt(2.0))) < 1e-14);
}

static void test_where_it_begins_changes_nothing_but_the_way(void **state)
{
    struct convex a = cube_at(0, 0, 0), b = cube_at(4, 5, -8);
    const struct vec3 guess[] = {{1, 0, 0}, {-1, -1, 1}, {0, 0, 0}, {2.0 / 7, 3.0 / 7, -6.0 / 7}};
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct gjk_start start = {.guess = guess[i]};
        assert_true(fabs(gjk_distance_from(&a, &b, &start).distance_m - 7.0) < 1e-14);
        assert_int_equal(start.count, 1); /* corner 3 of a, 4 of b */
        assert_true(start.a[0] == 3 && start.b[0] == 4);
        start = (struct gjk_start){.count = 3, .a = {0, 1, 0}, .b = {0, 7, 6}};
        assert_true(fabs(gjk_distance_from(&a, &b, &start).distance_m - 7.0) < 1e-14);
    }
}

static void test_a_limit_says_only_that_bodies_are_farther_apart(void **state)
{
    struct convex a = cube_at(0, 0, 0), b = cube_at(4, 5, -8);
    (void)state;
    for (int i = 0; i < 8; i++) {                   /* they are 7 m apart */
        double limit = i < 7 ? 3.5 + 0.5 * i : 8.0; /* up to 6.5 m, and 8 m */
        struct gjk_start start = {.guess = {1, 0, 0}};
        double found = gjk_distance_within(&a, &b, limit, &start).distance_m;
        assert_true(i < 7 ? found > limit && found < 7.0 + 1e-14 : fabs(found - 7.0) < 1e-14);
    }
    struct gjk_start start = {.guess = {1, 0, 0}}; /* the limit itself is not above the limit */
    assert_true(fabs(gjk_distance_within(&a, &b, 7.0, &start).distance_m - 7.0) < 1e-14);
}

static void test_support_is_the_first_of_the_farthest(void **state)
{
    struct convex a = cube_at(100, 100, 100);
    struct vec3 point;
    (void)state;
    assert_int_equal(gjk_support(&a, (struct vec3){1, 1, 1}, &point), 7);
    assert_true(near(point, (struct vec3){1, 1, 1}, 0.0)); /* relative to where it is */
    assert_int_equal(gjk_support(&a, (struct vec3){0, 1, 0}, &point), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cubes_face_to_face),
        cmocka_unit_test(test_cubes_corner_to_corner),
        cmocka_unit_test(test_edges_that_cross),
        cmocka_unit_test(test_points_and_what_they_touch),
        cmocka_unit_test(test_bodies_that_overlap_share_a_point_and_have_no_normal),
        cmocka_unit_test(test_coincident_bodies_overlap),
        cmocka_unit_test(test_scale_and_turn_count),
        cmocka_unit_test(test_where_it_begins_changes_nothing_but_the_way),
        cmocka_unit_test(test_a_limit_says_only_that_bodies_are_farther_apart),
        cmocka_unit_test(test_support_is_the_first_of_the_farthest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
