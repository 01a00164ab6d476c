/* Gaps between upright boxes, against the distances and overlaps of their rectangles on the map. */
#include "collider/geometry/level_gap.h"

#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define ROUNDS   4000
#define MARGIN_M 3.0

/* Corners and faces of a box with half sides 1, 1 and 2 (across, up and along), this far along its
 * nose, which is x in the body's axes. */
#define CORNERS(x)                                                                                 \
    {(x)-2, -1, -1}, {(x) + 2, -1, -1}, {(x)-2, 1, -1}, {(x) + 2, 1, -1}, {(x)-2, -1, 1},          \
        {(x) + 2, -1, 1}, {(x)-2, 1, 1},                                                           \
    {                                                                                              \
        (x) + 2, 1, 1                                                                              \
    }
#define FACES(x)                                                                                   \
    {{1, 0, 0}, (x) + 2}, {{-1, 0, 0}, 2 - (x)}, {{0, 1, 0}, 1}, {{0, -1, 0}, 1}, {{0, 0, 1}, 1},  \
    {                                                                                              \
        {0, 0, -1}, 1                                                                              \
    }
#define HULL(n, x)                                                                                 \
    .first_vertex = 8 * (n), .vertex_count = 8, .first_plane = 6 * (n), .plane_count = 6,          \
    .centre = {x, 0, 0}, .half = {2, 1, 1}, .radius_m = 2.4494897427831781

static const struct vec3 vertices[] = {CORNERS(0),   CORNERS(3),  CORNERS(-2), CORNERS(5),
                                       {-2, -1, -2}, {2, -1, -2}, {-2, -1, 2}, {-2, 1, -2},
                                       {2, 1, -2},   {-2, 1, 2}};
static const struct hull_plane planes[] = {FACES(0),
                                           FACES(3),
                                           {{-1, 0, 0}, 2},
                                           {{0, 0, -1}, 2},
                                           {{0, 1, 0}, 1},
                                           {{0, -1, 0}, 1},
                                           {{0.70710678118654757, 0, 0.70710678118654757}, 0}};
/* A box; the same 3 m further along its nose; the ends of one around both; a wedge whose slanting
 * side goes through its position. */
static const struct hull hulls[] = {
    {HULL(0, 0)},
    {HULL(1, 3)},
    {.vertex_count = 32, .centre = {1.5, 0, 0}, .half = {5.5, 1, 1}, .radius_m = 6.0},
    {.first_vertex = 32,
     .vertex_count = 6,
     .first_plane = 12,
     .plane_count = 5,
     .centre = {0, 0, 0},
     .half = {2, 1, 2},
     .radius_m = 3.0},
};

enum { BOX, FAR_BOX, OUTER, WEDGE };

static struct swept_body put(uint32_t first, uint32_t count, struct vec3 at, double heading_rad)
{
    struct quat turn = rotation_of(heading_rad, 0.0, 0.0);
    return (struct swept_body){.hull = &hulls[first],
                               .hull_count = count,
                               .outer = &hulls[OUTER],
                               .vertices = vertices,
                               .planes = planes,
                               .scale = 1.0,
                               .bound_m = 8.0,
                               .path = {.at = at},
                               .from = turn,
                               .to = turn};
}

/* --- the oracle --------------------------------------------------------------------------------*/

struct point {
    double x, z;
};

/* The corners of a body's box on the map, in turn around it. */
static void rectangle(const struct swept_body *body, struct point corner[4])
{
    static const double along[4] = {2, 2, -2, -2}, across[4] = {-1, 1, 1, -1};
    struct mat3 turn = rotation_matrix(body->from);
    for (int i = 0; i < 4; i++) {
        struct vec3 p = rotation_apply(&turn, (struct vec3){along[i], 0.0, across[i]});
        corner[i] = (struct point){body->path.at.x + p.x, body->path.at.z + p.z};
    }
}

static double to_side(struct point p, struct point from, struct point to)
{
    double x = to.x - from.x, z = to.z - from.z;
    double t = maths_clamp(((p.x - from.x) * x + (p.z - from.z) * z) / (x * x + z * z), 0.0, 1.0);
    double off_x = from.x + t * x - p.x, off_z = from.z + t * z - p.z;
    return sqrt(off_x * off_x + off_z * off_z);
}

/* Returns how far b is beyond a in a direction. */
static double beyond(const struct point a[4], const struct point b[4], double x, double z)
{
    double high = -INFINITY, low = INFINITY;
    for (int i = 0; i < 4; i++) {
        high = maths_max(high, a[i].x * x + a[i].z * z);
        low = maths_min(low, b[i].x * x + b[i].z * z);
    }
    return low - high;
}

/* Returns the separation along the best of the sides' normals and the line between the bodies. */
static double best_separation(const struct point a[4], const struct point b[4], struct vec3 line)
{
    double most = beyond(a, b, line.x, line.z);
    for (int i = 0; i < 4; i++) {
        double xa = a[(i + 1) % 4].x - a[i].x, za = a[(i + 1) % 4].z - a[i].z;
        double xb = b[(i + 1) % 4].x - b[i].x, zb = b[(i + 1) % 4].z - b[i].z;
        double la = sqrt(xa * xa + za * za), lb = sqrt(xb * xb + zb * zb);
        most = maths_max(most, beyond(a, b, -za / la, xa / la));
        most = maths_max(most, beyond(a, b, -zb / lb, xb / lb));
    }
    return most;
}

static double expected(const struct swept_body *a, const struct swept_body *b)
{
    struct point p[4], q[4];
    struct vec3 line = vec3_sub(b->path.at, a->path.at);
    line.y = 0.0;
    line = vec3_scale(line, 1.0 / vec3_length(line));
    rectangle(a, p);
    rectangle(b, q);
    double apart = best_separation(p, q, line), least = INFINITY;
    if (apart <= 0.0)
        return apart;
    for (int i = 0; i < 16; i++) {
        least = maths_min(least, to_side(p[i / 4], q[i % 4], q[(i + 1) % 4]));
        least = maths_min(least, to_side(q[i / 4], p[i % 4], p[(i + 1) % 4]));
    }
    return least;
}

/* --- boxes -------------------------------------------------------------------------------------*/

/* The deepest of overlaps is told if it is deep enough, and exactly if it is not deeper than asked
 * for. */
static void check_deepest(const struct swept_body *a, const struct swept_body *b, double right)
{
    static const double least_m[] = {0.02, 0.3}, enough_m[] = {0.3, 0.3};
    const struct turned_body turned_a = {a, level_gap_turn(a, 0.0)};
    const struct turned_body turned_b = {b, level_gap_turn(b, 0.0)};
    for (int i = 0; i < 2; i++) {
        struct level_gap deepest;
        assert_int_equal(level_gap_deepest(&turned_a, &turned_b, least_m[i], enough_m[i], &deepest),
                         right < -least_m[i]);
        if (right < -least_m[i] && right >= -enough_m[i])
            assert_true(fabs(deepest.gap_m - right) < 1e-9);
    }
}

static void check(const struct swept_body *a, const struct swept_body *b)
{
    struct level_gap gap[LEVEL_GAPS_MAX], back[LEVEL_GAPS_MAX];
    double right = expected(a, b);
    uint32_t count = level_gap_find(a, b, 0.0, MARGIN_M, NULL, gap);
    assert_int_equal(count, right <= MARGIN_M);
    assert_int_equal(level_gap_find(b, a, 0.0, MARGIN_M, NULL, back), count);
    assert_true(fabs(level_gap_least(a, b, 0.0, MARGIN_M) - maths_min(right, MARGIN_M)) < 1e-9);
    check_deepest(a, b, right);
    if (count == 0)
        return;
    assert_true(fabs(gap[0].gap_m - right) < 1e-9 && fabs(back[0].gap_m - right) < 1e-9);
    assert_true(gap[0].normal.y == 0.0 && fabs(vec3_length(gap[0].normal) - 1.0) < 1e-9);
    if (right > 1e-6)
        assert_true(vec3_length(vec3_add(gap[0].normal, back[0].normal)) < 1e-6);
}

static void test_random_boxes_agree_with_their_rectangles(void **state)
{
    uint64_t random = fixture_seed(132);
    int apart = 0, overlapping = 0;
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        struct swept_body a = put(BOX, 1, (struct vec3){30000.0, 100.0, 20000.0},
                                  fixture_uniform(&random, 0.0, TWO_PI));
        struct vec3 at = {30000.0 + fixture_uniform(&random, -5.0, 5.0),
                          100.0 + fixture_uniform(&random, -0.9, 0.9),
                          20000.0 + fixture_uniform(&random, -5.0, 5.0)};
        struct swept_body b = put(BOX, 1, at, fixture_uniform(&random, 0.0, TWO_PI));
        *(expected(&a, &b) > 0.0 ? &apart : &overlapping) += 1;
        check(&a, &b);
    }
    assert_true(apart > ROUNDS / 5 && overlapping > ROUNDS / 5);
}

static void test_faces_touch_along_their_shared_edge(void **state)
{
    struct level_gap gap[LEVEL_GAPS_MAX];
    struct swept_body a = put(BOX, 1, (struct vec3){100, 0, 0}, HALF_PI);
    struct swept_body b = put(BOX, 1, (struct vec3){104.5, 0, 0.5}, HALF_PI);
    (void)state;
    assert_int_equal(level_gap_find(&a, &b, 0.0, 1.0, NULL, gap), 1);
    assert_true(fabs(gap[0].gap_m - 0.5) < 1e-12 && gap[0].normal.x > 0.999999);
    assert_int_equal(gap[0].points, 2); /* z from -0.5 to 1 */
    double low = maths_min(gap[0].point[0].z, gap[0].point[1].z);
    double high = maths_max(gap[0].point[0].z, gap[0].point[1].z);
    assert_true(fabs(low + 0.5) < 0.01 && fabs(high - 1.0) < 0.01);
    b.from = b.to = rotation_of(HALF_PI + 0.6, 0.0, 0.0); /* a corner is foremost */
    assert_int_equal(level_gap_find(&a, &b, 0.0, 1.0, NULL, gap), 1);
    assert_int_equal(gap[0].points, 1);
}

/* A corner of the box is 0.1 m deep in the slanting side of the wedge, the second body. */
static void test_a_corner_leaves_a_slanting_side_along_its_normal(void **state)
{
    struct level_gap gap[LEVEL_GAPS_MAX];
    double half = 0.70710678118654757, off = 0.1 * half;
    struct swept_body a = put(BOX, 1, (struct vec3){2.0 - off, 0, 1.0 - off}, HALF_PI);
    struct swept_body b = put(WEDGE, 1, (struct vec3){0, 0, 0}, HALF_PI);
    (void)state;
    assert_int_equal(level_gap_find(&a, &b, 0.0, 1.0, NULL, gap), 1);
    assert_true(fabs(gap[0].gap_m + 0.1) < 1e-9);
    assert_true(vec3_length(vec3_sub(gap[0].normal, (struct vec3){-half, 0, -half})) < 1e-9);
    assert_int_equal(level_gap_find(&b, &a, 0.0, 1.0, NULL, gap), 1);
    assert_true(fabs(gap[0].gap_m + 0.1) < 1e-9);
    assert_true(vec3_length(vec3_sub(gap[0].normal, (struct vec3){half, 0, half})) < 1e-9);
}

/* A body that lies straight over another does not come nearer on the map. */
static void test_bodies_above_each_other_are_no_neighbours(void **state)
{
    struct level_gap gap[LEVEL_GAPS_MAX];
    struct swept_body a = put(BOX, 1, (struct vec3){0, 0, 0}, HALF_PI);
    struct swept_body b = put(BOX, 1, (struct vec3){0.5, 2.5, 0}, HALF_PI);
    (void)state;
    assert_int_equal(level_gap_find(&a, &b, 0.0, 0.4, NULL, gap), 0);
    assert_int_equal(level_gap_find(&a, &b, 0.0, 0.6, NULL, gap), 1);
    assert_true(gap[0].normal.x == 1.0 && gap[0].gap_m > 100.0);
}

static void test_the_gap_is_that_of_the_time(void **state)
{
    struct swept_body a = put(BOX, 1, (struct vec3){0, 0, 0}, HALF_PI);
    struct swept_body b = put(BOX, 1, (struct vec3){6, 0, 0}, HALF_PI);
    (void)state;
    b.path.along.x = -3.0;
    assert_true(fabs(level_gap_least(&a, &b, 0.0, MARGIN_M) - 2.0) < 1e-9);
    assert_true(fabs(level_gap_least(&a, &b, 0.5, MARGIN_M) - 0.5) < 1e-9);
    assert_true(fabs(level_gap_least(&a, &b, 1.0, MARGIN_M) + 1.0) < 1e-9);
}

/* --- several hulls -----------------------------------------------------------------------------*/

/* The second of the hulls is in the other body deeper than the first. */
static void test_the_least_gap_is_that_of_the_deepest_hulls(void **state)
{
    uint64_t random = fixture_seed(133);
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        struct level_gap gap[LEVEL_GAPS_MAX];
        struct swept_body a = put(BOX, 2, (struct vec3){0, 0, 0}, HALF_PI);
        struct vec3 at = {fixture_uniform(&random, -3.0, 7.0), fixture_uniform(&random, -2.1, 2.1),
                          fixture_uniform(&random, -3.0, 3.0)};
        struct swept_body b = put(BOX, 2, at, fixture_uniform(&random, 0.0, TWO_PI));
        uint32_t count = level_gap_find(&a, &b, 0.0, 0.5, NULL, gap);
        double least = count > 0 ? maths_min(gap[0].gap_m, 0.5) : 0.5;
        assert_true(fabs(level_gap_least(&a, &b, 0.0, 0.5) - least) < 1e-9);
        assert_true(fabs(level_gap_least(&b, &a, 0.0, 0.5) - least) < 1e-9);
        for (uint32_t i = 1; i < count; i++)
            assert_true(gap[i - 1].gap_m <= gap[i].gap_m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_boxes_agree_with_their_rectangles),
        cmocka_unit_test(test_faces_touch_along_their_shared_edge),
        cmocka_unit_test(test_a_corner_leaves_a_slanting_side_along_its_normal),
        cmocka_unit_test(test_bodies_above_each_other_are_no_neighbours),
        cmocka_unit_test(test_the_gap_is_that_of_the_time),
        cmocka_unit_test(test_the_least_gap_is_that_of_the_deepest_hulls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
