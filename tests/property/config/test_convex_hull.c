/* Convex hulls, compared with a search of every plane through three points (row 38: the shape of
 * bodies). */
#include "config/mesh/convex_hull.h"

#include "tests/support/fixture.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ROUNDS     3000
#define POINTS_MAX 14
#define LATTICE    80

/* --- drawing -----------------------------------------------------------------------------------*/

/* Draws sets of points: anywhere; on a coarse lattice, where most share planes and lines and some
 * coincide; on a sphere; in two clusters; far from the origin. */
static uint32_t draw(struct vec3 *point, uint64_t *random)
{
    uint32_t count = 4 + (uint32_t)(fixture_random(random) % (POINTS_MAX - 3));
    uint32_t way = (uint32_t)(fixture_random(random) % 5);
    double size = way == 1 ? 1.0 : fixture_uniform(random, 0.05, 30.0);
    struct vec3 at = {0.0, 0.0, 0.0};
    if (fixture_random(random) % 3 == 0)
        at = (struct vec3){fixture_uniform(random, -500, 500), 12.0, -77.0};
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 p = {fixture_uniform(random, -1, 1), fixture_uniform(random, -1, 1),
                         fixture_uniform(random, -1, 1)};
        if (way == 1 || way == 2)
            p = (struct vec3){floor(1.5 * p.x + 0.5), floor(1.5 * p.y + 0.5),
                              floor(1.5 * p.z + 0.5)};
        if (way == 3)
            p = vec3_scale(p, 1.0 / vec3_length(p));
        if (way == 4)
            p.x = p.x * 0.1 + (i % 2 == 0 ? 1.0 : -1.0);
        point[i] = vec3_add(at, vec3_scale(p, size));
    }
    return count;
}

/* --- the oracle --------------------------------------------------------------------------------*/

/* The area of the convex hull of points in the plane of this normal. Its edges are those pairs that
 * have all other points on one side. */
static double area_on(const struct vec3 *point, uint32_t count, struct vec3 normal)
{
    double area = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = 0; j < count; j++) {
            struct vec3 edge = vec3_sub(point[j], point[i]);
            double length = vec3_length(edge);
            bool outer = length > 1e-9;
            for (uint32_t k = 0; outer && k < count; k++) {
                struct vec3 to = vec3_sub(point[k], point[i]);
                double left = vec3_dot(normal, vec3_cross(edge, to)), along = vec3_dot(edge, to);
                /* A point on the line of the edge must lie between its ends. */
                outer = left > 1e-9 * length || (left > -1e-9 * length && along >= -1e-9 &&
                                                 along <= length * length + 1e-9);
            }
            if (outer)
                area += 0.5 * vec3_dot(normal, vec3_cross(vec3_sub(point[i], point[0]),
                                                          vec3_sub(point[j], point[0])));
        }
    }
    return area;
}

static bool is_given(const struct vec3 *point, uint32_t count, struct vec3 p)
{
    for (uint32_t i = 0; i < count; i++) {
        if (vec3_length(vec3_sub(point[i], p)) < 1e-6)
            return true;
    }
    return false;
}

/* The volume of the hull: the sum over every plane that has all points on one side, each plane
 * once. */
static double volume_of(const struct vec3 *given, uint32_t all)
{
    struct vec3 point[POINTS_MAX];
    uint32_t count = 0;
    for (uint32_t i = 0; i < all; i++) {
        if (!is_given(point, count, given[i]))
            point[count++] = given[i];
    }
    struct vec3 seen[POINTS_MAX * POINTS_MAX * POINTS_MAX];
    uint32_t planes = 0;
    double volume = 0.0;
    for (uint32_t n = 0; n < count * count * count; n++) {
        uint32_t a = n % count, b = n / count % count, c = n / count / count;
        struct vec3 on[POINTS_MAX];
        struct vec3 normal = vec3_cross(vec3_sub(point[b], point[a]), vec3_sub(point[c], point[a]));
        double length = vec3_length(normal);
        uint32_t flat = 0;
        bool outer = length > 1e-7;
        if (!outer)
            continue;
        normal = vec3_scale(normal, 1.0 / length);
        for (uint32_t i = 0; outer && i < count; i++) {
            double above = vec3_dot(normal, vec3_sub(point[i], point[a]));
            outer = above <= 1e-9;
            if (above >= -1e-9)
                on[flat++] = point[i];
        }
        for (uint32_t i = 0; outer && i < planes; i++)
            outer = vec3_length(vec3_sub(seen[i], normal)) > 1e-7;
        if (!outer)
            continue;
        seen[planes++] = normal;
        volume += area_on(on, flat, normal) * vec3_dot(normal, vec3_sub(point[a], point[0])) / 3.0;
    }
    return volume;
}

/* --- properties --------------------------------------------------------------------------------*/

static void check_holds(const struct convex_hull *hull, const struct vec3 *point, uint32_t count)
{
    for (uint32_t f = 0; f < hull->face_count; f++) {
        for (uint32_t i = 0; i < count; i++)
            assert_true(vec3_dot(hull->face[f].normal, point[i]) - hull->face[f].offset_m < 1e-6);
    }
}

/* Every edge occurs once in each direction, and no corner is above a triangle. */
static void check_closed(const struct convex_hull *hull)
{
    uint8_t walked[2 * LATTICE][2 * LATTICE] = {{0}};
    for (uint32_t f = 0; f < hull->face_count; f++) {
        const uint32_t *corner = hull->face[f].corner;
        for (int k = 0; k < 3; k++)
            walked[corner[k]][corner[(k + 1) % 3]]++;
        for (uint32_t i = 0; i < hull->point_count; i++)
            assert_true(vec3_dot(hull->face[f].normal, hull->point[i]) - hull->face[f].offset_m <
                        1e-10);
    }
    for (uint32_t i = 0; i < hull->point_count; i++) {
        for (uint32_t k = 0; k < hull->point_count; k++)
            assert_true(walked[i][k] <= 1 && walked[i][k] == walked[k][i]);
    }
    assert_int_equal(hull->face_count, 2 * hull->point_count - 4);
}

static void check_near(double is, double expected, double size)
{
    if (fabs(is - expected) > 1e-5 * size * size)
        fail_msg("%.12g, not %.12g", is, expected);
}

static double size_of(const struct vec3 *point, uint32_t count)
{
    double size = 0.1;
    for (uint32_t i = 1; i < count; i++)
        size = maths_max(size, vec3_length(vec3_sub(point[i], point[0])));
    return size;
}

static void check_one(const struct vec3 *point, uint32_t count)
{
    struct convex_hull hull;
    double volume = volume_of(point, count), size = size_of(point, count);
    if (convex_hull_points(&hull, point, count) != 0) {
        assert_int_equal(errno, EDOM);
        assert_true(volume <
                    1e-5 * size * size); /* true: the points are no thicker than the slack */
        return;
    }
    check_near(hull.volume_m3, volume, size);
    check_holds(&hull, point, count);
    check_closed(&hull);
    for (uint32_t i = 0; i < hull.point_count; i++)
        assert_true(is_given(point, count, hull.point[i]));
    convex_hull_free(&hull);
}

static void test_hull_equals_search_of_all_planes(void **state)
{
    uint64_t random = fixture_seed(38);
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        struct vec3 point[POINTS_MAX];
        uint32_t count = draw(point, &random);
        check_one(point, count);
    }
}

/* The same set in another order, with every point twice. */
static void test_order_and_repetition_change_nothing(void **state)
{
    uint64_t random = fixture_seed(39);
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        struct vec3 point[2 * POINTS_MAX];
        struct convex_hull first, second;
        uint32_t count = draw(point, &random);
        if (convex_hull_points(&first, point, count) != 0)
            continue;
        memcpy(point + count, point, count * sizeof *point);
        for (uint32_t i = 2 * count - 1; i > 0; i--) {
            uint32_t other = (uint32_t)(fixture_random(&random) % (i + 1));
            struct vec3 swap = point[i];
            point[i] = point[other];
            point[other] = swap;
        }
        assert_int_equal(convex_hull_points(&second, point, 2 * count), 0);
        check_near(second.volume_m3, first.volume_m3, size_of(point, 2 * count));
        assert_true(convex_hull_holds(&first, &second, 1e-6) &&
                    convex_hull_holds(&second, &first, 1e-6));
        convex_hull_free(&first);
        convex_hull_free(&second);
    }
}

static void test_joined_hull_equals_hull_of_all_points(void **state)
{
    uint64_t random = fixture_seed(40);
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        struct vec3 point[2 * POINTS_MAX];
        struct convex_hull a, b, both, all;
        uint32_t first = draw(point, &random), second = draw(point + first, &random);
        double volume, size = size_of(point, first + second);
        if (convex_hull_points(&a, point, first) != 0)
            continue;
        if (convex_hull_points(&b, point + first, second) == 0) {
            assert_int_equal(convex_hull_both(&both, &a, &b), 0);
            assert_int_equal(convex_hull_volume(&volume, &a, &b), 0);
            assert_int_equal(convex_hull_points(&all, point, first + second), 0);
            assert_true(volume == both.volume_m3);
            check_closed(&both);
            check_near(volume, all.volume_m3, size);
            assert_true(convex_hull_holds(&both, &a, 1e-6) && convex_hull_holds(&both, &b, 1e-6));
            assert_true(convex_hull_holds(&a, &b, 1e-6) ==
                            (volume < a.volume_m3 + 1e-5 * size * size) ||
                        volume < 1e-4 * size * size);
            convex_hull_free(&b);
            convex_hull_free(&both);
            convex_hull_free(&all);
        }
        convex_hull_free(&a);
    }
}

static void test_growth_is_the_volume_that_a_point_adds(void **state)
{
    uint64_t random = fixture_seed(41);
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        struct vec3 point[POINTS_MAX];
        struct convex_hull without, with;
        uint32_t count = draw(point, &random);
        if (convex_hull_points(&without, point, count - 1) != 0)
            continue;
        assert_int_equal(convex_hull_points(&with, point, count), 0);
        check_near(convex_hull_growth(&without, point[count - 1]),
                   with.volume_m3 - without.volume_m3, size_of(point, count));
        convex_hull_free(&without);
        convex_hull_free(&with);
    }
}

/* Faces and edges of many points that rounding to a file's decimals has left nearly flat. */
static void test_nearly_flat_points_give_a_closed_hull(void **state)
{
    uint64_t random = fixture_seed(42);
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        struct vec3 exact[LATTICE], rough[LATTICE];
        struct convex_hull hull, other;
        double jitter = fixture_uniform(&random, -9.0, -3.0), size = 0.0;
        uint32_t count = 8 + (uint32_t)(fixture_random(&random) % (LATTICE - 7));
        uint64_t side = 2 + fixture_random(&random) % 4;
        jitter = exp2(jitter * 3.3219); /* 1e-9 to 1e-3 */
        for (uint32_t i = 0; i < count; i++) {
            double x = (double)(fixture_random(&random) % side);
            double y = (double)(fixture_random(&random) % side);
            double z = (double)(fixture_random(&random) % side);
            exact[i] = (struct vec3){0.8 * x - 0.6 * z, y, 0.6 * x + 0.8 * z};
            rough[i] = exact[i];
            rough[i].x += jitter * fixture_uniform(&random, -1, 1);
            rough[i].y += jitter * fixture_uniform(&random, -1, 1);
            rough[i].z += jitter * fixture_uniform(&random, -1, 1);
        }
        if (convex_hull_points(&hull, exact, count) != 0)
            continue;
        size = size_of(exact, count);
        assert_int_equal(convex_hull_points(&other, rough, count), 0);
        check_closed(&hull);
        check_closed(&other);
        check_holds(&other, rough, count);
        assert_true(fabs(other.volume_m3 - hull.volume_m3) < (10.0 * jitter + 1e-5) * size * size);
        convex_hull_free(&hull);
        convex_hull_free(&other);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hull_equals_search_of_all_planes),
        cmocka_unit_test(test_order_and_repetition_change_nothing),
        cmocka_unit_test(test_joined_hull_equals_hull_of_all_points),
        cmocka_unit_test(test_growth_is_the_volume_that_a_point_adds),
        cmocka_unit_test(test_nearly_flat_points_give_a_closed_hull),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
