/* Where bodies touch: the middle of two faces, and points and edges. */
#include "collider/geometry/contact_manifold.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static const struct vec3 cube[8] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                    {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
static const struct mat3 upright = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
static const struct vec3 east = {1, 0, 0}, up = {0, 1, 0};
static struct contact_manifold patch;

static struct convex cube_at(double x, double y, double z)
{
    return (struct convex){cube, 8, 1.0, upright, {x, y, z}};
}

static bool near(struct vec3 a, double x, double y, double z)
{
    return vec3_length(vec3_sub(a, (struct vec3){x, y, z})) <= 2.0 * CONTACT_MANIFOLD_SLACK_M;
}

static void test_faces_touch_in_the_middle_of_the_shared_area(void **state)
{
    struct convex a = cube_at(100, 0, 0), b = cube_at(102.001, 1.5, -0.5);
    (void)state;
    assert_true(contact_manifold_between(&a, &b, east, &patch));
    assert_int_equal(patch.count, 4);
    assert_true(near(patch.middle, 101, 0.75, -0.25));
    for (uint32_t i = 0; i < patch.count; i++) {
        assert_true(fabs(patch.corner[i].x - 101.0005) < 1e-12); /* midway */
        assert_true(fabs(fabs(patch.corner[i].y - 0.75) - 0.25) < 2.0 * CONTACT_MANIFOLD_SLACK_M);
        assert_true(fabs(fabs(patch.corner[i].z + 0.25) - 0.75) < 2.0 * CONTACT_MANIFOLD_SLACK_M);
    }
}

static void test_a_face_turned_on_another(void **state)
{
    struct convex a = cube_at(0, 0, 0), b = cube_at(0, 2, 0);
    (void)state;
    b.turn = rotation_matrix(rotation_of(0.25 * PI, 0.0, 0.0));
    assert_true(contact_manifold_between(&a, &b, up, &patch));
    assert_int_equal(patch.count, 8);
    assert_true(near(patch.middle, 0, 1, 0));
}

static void test_overlapping_bodies_touch_midway(void **state)
{
    struct convex a = cube_at(0, 0, 0), b = cube_at(0.5, 1.5, 0.5);
    (void)state;
    assert_true(contact_manifold_between(&a, &b, up, &patch));
    assert_true(near(patch.middle, 0.25, 0.75, 0.25));
}

static void test_an_edge_on_a_face(void **state)
{
    struct convex a = cube_at(0, 0, 0), b = cube_at(0.25, 1.0 + sqrt(2.0), 0.5);
    (void)state;
    b.turn = rotation_matrix(rotation_of(HALF_PI, 0.0, 0.25 * PI)); /* an edge along x is lowest */
    assert_true(contact_manifold_between(&a, &b, up, &patch));
    assert_true(near(patch.middle, 0.125, 1, 0.5)); /* x from -0.75 to 1 */
    assert_true(contact_manifold_between(&b, &a, (struct vec3){0, -1, 0}, &patch));
    assert_true(near(patch.middle, 0.125, 1, 0.5));
}

static void test_edges_along_each_other_and_across(void **state)
{
    struct convex a = cube_at(0, 0, 0), b = cube_at(0.5, 2.0 * sqrt(2.0), 0);
    (void)state;
    a.turn = rotation_matrix(rotation_of(HALF_PI, 0.0, 0.25 * PI));
    b.turn = a.turn;
    assert_true(contact_manifold_between(&a, &b, up, &patch));
    assert_true(near(patch.middle, 0.25, sqrt(2.0), 0));
    b.turn = rotation_matrix(rotation_of(0.0, 0.0, 0.25 * PI)); /* now along z */
    assert_true(contact_manifold_between(&a, &b, up, &patch));
    assert_true(near(patch.middle, 0.5, sqrt(2.0), 0));
}

static void test_a_corner_is_where_it_is(void **state)
{
    const struct vec3 point = {0, 0, 0};
    struct convex a = cube_at(0, 0, 0);
    struct convex b = {&point, 1, 1.0, upright, {0.5, 1, -0.25}};
    (void)state;
    assert_true(contact_manifold_between(&a, &b, up, &patch));
    assert_int_equal(patch.count, 1);
    assert_true(near(patch.middle, 0.5, 1, -0.25));
    assert_true(contact_manifold_between(&b, &a, (struct vec3){0, -1, 0}, &patch));
    assert_true(near(patch.middle, 0.5, 1, -0.25));
    assert_true(contact_manifold_between(&b, &b, up, &patch));
    assert_true(near(patch.middle, 0.5, 1, -0.25));
}

static void test_what_is_foremost_may_be_beside_the_other(void **state)
{
    struct convex a = cube_at(0, 0, 0), b = cube_at(2.1, 2, 0);
    (void)state;
    assert_false(contact_manifold_between(&a, &b, up, &patch));
}

/* A drum's end is 128 corners; two of them are the most that there can be. */
static void test_the_most_corners(void **state)
{
    static struct vec3 drum[256];
    struct convex a = {drum, 256, 1.0, upright, {0, 0, 0}}, b = a;
    (void)state;
    for (int i = 0; i < 256; i++) {
        double sine, cosine;
        maths_sincos(TWO_PI * i / 256.0, &sine, &cosine);
        drum[i] = (struct vec3){cosine, 0, sine};
    }
    b.at.x = 0.3;
    b.turn = rotation_matrix(rotation_of(0.001, 0.0, 0.0));
    assert_true(contact_manifold_between(&a, &b, up, &patch));
    assert_true(near(patch.middle, 0.15, 0, 0));
    assert_true(patch.count > 150);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_faces_touch_in_the_middle_of_the_shared_area),
        cmocka_unit_test(test_a_face_turned_on_another),
        cmocka_unit_test(test_overlapping_bodies_touch_midway),
        cmocka_unit_test(test_an_edge_on_a_face),
        cmocka_unit_test(test_edges_along_each_other_and_across),
        cmocka_unit_test(test_a_corner_is_where_it_is),
        cmocka_unit_test(test_what_is_foremost_may_be_beside_the_other),
        cmocka_unit_test(test_the_most_corners),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
