/* Distances of convex bodies against oracles that share nothing with GJK: every pair of features
 * of small bodies, the planes between overlapping ones, and big bodies put at known distances.
 * SEED=n runs another set. */
#include "collider/geometry/gjk.h"

#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define PAIRS       100000
#define KNOWN_PAIRS 25000
#define POINTS_MAX  256
#define SLACK_M     1e-9

static struct mat3 any_turn(uint64_t *random)
{
    return rotation_matrix(rotation_spun(rotation_of(0.0, 0.0, 0.0), fixture_direction(random),
                                         fixture_uniform(random, 0.0, PI)));
}

/* A body and where its points are, relative to the first body's at. */
struct solid {
    struct convex convex;
    struct vec3 vertex[POINTS_MAX], world[POINTS_MAX];
};

static void place(struct solid *solid, struct vec3 origin)
{
    const struct convex *c = &solid->convex;
    for (uint32_t i = 0; i < c->count; i++)
        solid->world[i] = vec3_add(rotation_apply(&c->turn, vec3_scale(c->vertex[i], c->scale)),
                                   vec3_sub(c->at, origin));
}

static double reach(const struct solid *solid, struct vec3 n)
{
    double most = -INFINITY;
    for (uint32_t i = 0; i < solid->convex.count; i++)
        most = maths_max(most, vec3_dot(solid->world[i], n));
    return most;
}

/* How far b is beyond a along n. */
static double apart(const struct solid *a, const struct solid *b, struct vec3 n)
{
    return -reach(b, vec3_scale(n, -1.0)) - reach(a, n);
}

/* --- every pair of features --------------------------------------------------------------------*/

/* Square of the distance when the point's foot is inside the triangle; the edges do the rest. */
static double point_triangle(struct vec3 p, const struct vec3 t[3])
{
    struct vec3 u = vec3_sub(t[1], t[0]), v = vec3_sub(t[2], t[0]), w = vec3_sub(p, t[0]);
    struct vec3 n = vec3_cross(u, v);
    double nn = vec3_dot(n, n);
    if (!(nn > 1e-24 * vec3_dot(u, u) * vec3_dot(v, v)))
        return INFINITY;
    double s = vec3_dot(vec3_cross(w, v), n) / nn, r = vec3_dot(vec3_cross(u, w), n) / nn;
    if (s < 0.0 || r < 0.0 || s + r > 1.0)
        return INFINITY;
    double h = vec3_dot(w, n);
    return h * h / nn;
}

static double segments(struct vec3 p, struct vec3 p1, struct vec3 q, struct vec3 q1)
{
    struct vec3 d = vec3_sub(p1, p), e = vec3_sub(q1, q), r = vec3_sub(p, q);
    double dd = vec3_dot(d, d), ee = vec3_dot(e, e), de = vec3_dot(d, e);
    double dr = vec3_dot(d, r), er = vec3_dot(e, r), s = 0.0, t = 0.0;
    double across = dd * ee - de * de;
    if (across > 1e-20 * dd * ee)
        s = maths_clamp((de * er - dr * ee) / across, 0.0, 1.0);
    if (ee > 0.0)
        t = maths_clamp((de * s + er) / ee, 0.0, 1.0);
    if (dd > 0.0)
        s = maths_clamp((de * t - dr) / dd, 0.0, 1.0);
    struct vec3 between = vec3_add(r, vec3_sub(vec3_scale(d, s), vec3_scale(e, t)));
    return vec3_dot(between, between);
}

static double points_triangles(const struct solid *a, const struct solid *b)
{
    double least = INFINITY;
    for (uint32_t i = 0; i < b->convex.count; i++) {
        for (uint32_t j = i + 1; j < b->convex.count; j++) {
            for (uint32_t k = j + 1; k < b->convex.count; k++) {
                const struct vec3 t[3] = {b->world[i], b->world[j], b->world[k]};
                for (uint32_t p = 0; p < a->convex.count; p++)
                    least = maths_min(least, point_triangle(a->world[p], t));
            }
        }
    }
    return least;
}

static double edges_edges(const struct solid *a, const struct solid *b)
{
    double least = INFINITY;
    for (uint32_t i = 0; i < a->convex.count; i++) {
        for (uint32_t j = i; j < a->convex.count; j++) {
            for (uint32_t k = 0; k < b->convex.count; k++) {
                for (uint32_t l = k; l < b->convex.count; l++)
                    least = maths_min(least,
                                      segments(a->world[i], a->world[j], b->world[k], b->world[l]));
            }
        }
    }
    return least;
}

/* Distance of bodies that do not overlap. */
static double features(const struct solid *a, const struct solid *b)
{
    return sqrt(
        maths_min(edges_edges(a, b), maths_min(points_triangles(a, b), points_triangles(b, a))));
}

/* The farthest apart they are along any axis that could separate two polyhedra. */
static double most_apart(const struct solid *a, const struct solid *b)
{
    struct vec3 edge[2][POINTS_MAX];
    int count[2] = {0, 0};
    double most = -INFINITY;
    const struct solid *const solid[2] = {a, b};
    for (int s = 0; s < 2; s++) {
        for (uint32_t i = 0; i < solid[s]->convex.count; i++) {
            for (uint32_t j = 0; j < i; j++)
                edge[s][count[s]++] = vec3_sub(solid[s]->world[i], solid[s]->world[j]);
        }
    }
    for (int s = 0; s < 3; s++) { /* faces of a, faces of b, edges of both */
        for (int i = 0; i < count[s == 1]; i++) {
            for (int j = 0; j < count[s > 0]; j++) {
                struct vec3 n = vec3_cross(edge[s == 1][i], edge[s > 0][j]);
                double length = vec3_length(n);
                if (length < 1e-12)
                    continue;
                n = vec3_scale(n, 1.0 / length);
                most = maths_max(most, maths_max(apart(a, b, n), apart(a, b, vec3_scale(n, -1))));
            }
        }
    }
    return most;
}

/* --- small bodies ------------------------------------------------------------------------------*/

enum sort { GENERIC, BOXES, FLAT, FEW, NEEDLES, TWELVE, SORTS };

static void draw(struct solid *solid, enum sort sort, uint64_t *random)
{
    struct vec3 size = {fixture_uniform(random, 0.1, 10), fixture_uniform(random, 0.1, 10),
                        fixture_uniform(random, 0.1, 10)};
    uint32_t count = 4 + (uint32_t)(fixture_random(random) % 2);
    if (sort == FLAT)
        size.y = 0.0;
    if (sort == NEEDLES)
        size.x = size.z = 1e-6 * fixture_uniform(random, 0.0, 1.0);
    if (sort == TWELVE)
        count = 12;
    if (sort == FEW)
        count = 1 + (uint32_t)(fixture_random(random) % 3);
    if (sort == BOXES)
        count = 8;
    for (uint32_t i = 0; i < count; i++) {
        double x = sort == BOXES ? (i & 1 ? 1 : -1) : fixture_uniform(random, -1, 1);
        double y = sort == BOXES ? (i & 2 ? 1 : -1) : fixture_uniform(random, -1, 1);
        double z = sort == BOXES ? (i & 4 ? 1 : -1) : fixture_uniform(random, -1, 1);
        solid->vertex[i] = (struct vec3){x * size.x, y * size.y, z * size.z};
    }
    solid->convex =
        (struct convex){solid->vertex,
                        count,
                        fixture_uniform(random, 0.5, 2.0),
                        any_turn(random),
                        {fixture_uniform(random, 0, 50000), fixture_uniform(random, 0, 3000),
                         fixture_uniform(random, 0, 50000)}};
}

/* Puts b beside a: apart, touching, parallel, or overlapping. */
static void put_beside(const struct solid *a, struct solid *b, int how, uint64_t *random)
{
    struct vec3 n = fixture_direction(random), on_a, on_b;
    double gap = fixture_uniform(random, 0.0, how == 0 ? 20.0 : 0.01);
    if (how == 1) { /* parallel, so that faces and edges are */
        b->convex.turn = a->convex.turn;
        n = rotation_apply(&a->convex.turn, (struct vec3){0, 1, 0});
    }
    if (how == 2)
        gap = 0.0;
    if (how == 3)
        gap = -fixture_uniform(random, 0.0, 10.0);
    gjk_support(&a->convex, n, &on_a);
    gjk_support(&b->convex, vec3_scale(n, -1.0), &on_b);
    b->convex.at = vec3_add(a->convex.at, vec3_add(vec3_sub(on_a, on_b), vec3_scale(n, gap)));
    if (how == 1) {
        struct vec3 aside = {fixture_uniform(random, -3, 3), 0, fixture_uniform(random, -3, 3)};
        b->convex.at = vec3_add(b->convex.at, rotation_apply(&a->convex.turn, aside));
    }
}

/* Is it what the features say? NaN never is. */
static bool right(const struct solid *a, const struct solid *b, const struct gjk *gjk)
{
    if (gjk->distance_m == 0.0)
        return vec3_length(gjk->normal) == 0.0 &&
               vec3_length(vec3_sub(gjk->on_a, gjk->on_b)) == 0.0 &&
               (most_apart(a, b) < SLACK_M || features(a, b) < SLACK_M);
    struct vec3 across =
        vec3_sub(vec3_sub(gjk->on_b, gjk->on_a), vec3_scale(gjk->normal, gjk->distance_m));
    return fabs(vec3_length(gjk->normal) - 1.0) < 1e-14 && vec3_length(across) < 1e-7 &&
           fabs(apart(a, b, gjk->normal) - gjk->distance_m) < SLACK_M &&
           fabs(features(a, b) - gjk->distance_m) < SLACK_M;
}

static void test_the_distance_is_that_of_the_nearest_features(void **state)
{
    static struct solid a, b;
    uint64_t random = fixture_seed(310), overlaps = 0;
    (void)state;
    for (int n = 0; n < PAIRS; n++) {
        enum sort sort_a = (enum sort)(n % 5), sort_b = (enum sort)(n / 5 % 5);
        if (n % 256 == 0)
            sort_a = sort_b = TWELVE;
        draw(&a, sort_a, &random);
        draw(&b, sort_b, &random);
        put_beside(&a, &b, n / 25 % 4, &random);
        place(&a, a.convex.at);
        place(&b, a.convex.at);
        struct gjk gjk = gjk_distance(&a.convex, &b.convex);
        overlaps += gjk.distance_m == 0.0;
        if (!right(&a, &b, &gjk))
            fail_msg("pair %d, sorts %d and %d: %.17g m, features %.17g, apart %.17g", n,
                     (int)sort_a, (int)sort_b, gjk.distance_m, features(&a, &b),
                     most_apart(&a, &b));
    }
    assert_in_range(overlaps, PAIRS / 20, PAIRS / 2);
}

/* --- big bodies at known distances -------------------------------------------------------------*/

enum form { BALL, DRUM, BOX, PLATE, NEEDLE, POINT, FORMS };

static void form(struct solid *solid, enum form shape, double size, uint64_t *random)
{
    struct vec3 half = {size, size * fixture_uniform(random, 0.01, 1.0),
                        size * fixture_uniform(random, 0.01, 1.0)};
    uint32_t count = shape == BALL || shape == DRUM ? POINTS_MAX : shape == POINT ? 1 : 8;
    if (shape == PLATE)
        half.y = 1e-9 * size;
    if (shape == NEEDLE)
        half.y = half.z = 1e-6 * size;
    for (uint32_t i = 0; i < count; i++) {
        double sine, cosine;
        maths_sincos(TWO_PI * floor(0.5 * i) / 128.0, &sine, &cosine);
        solid->vertex[i] =
            shape == BALL ? vec3_scale(fixture_direction(random), size)
            : shape == DRUM
                ? (struct vec3){half.z * cosine, i & 1 ? half.y : -half.y, half.z * sine}
                : (struct vec3){i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y,
                                i & 4 ? half.z : -half.z};
    }
    solid->convex = (struct convex){
        solid->vertex, count, fixture_uniform(random, 0.5, 1.0), any_turn(random), {0.0, 0.0, 0.0}};
}

/* Two bodies on both sides of a slab, each touching it where the other does: its thickness is their
 * distance. Sizes are from a millimetre to 100 m, and of one pair as different as that. */
static void test_big_small_and_thin_bodies_are_as_far_apart_as_they_were_put(void **state)
{
    static struct solid a, b;
    const double gap[] = {1000.0, 1.0, 1e-3, 1e-6, 1e-8, 0.0}, size[] = {100.0, 100.0, 3.0, 1e-3};
    uint64_t random =
        fixture_seed(13); /* has pairs that need ties, and ones that need a second look */
    (void)state;
    for (int n = 0; n < KNOWN_PAIRS; n++) {
        struct vec3 slab = fixture_direction(&random), on_a, on_b;
        double want = gap[n % 6];
        form(&a, (enum form)(n / 6 % FORMS), size[fixture_random(&random) % 4], &random);
        form(&b, (enum form)(n / 36 % FORMS), size[fixture_random(&random) % 4], &random);
        a.convex.at = (struct vec3){fixture_uniform(&random, 0, 50000), 0,
                                    fixture_uniform(&random, 0, 50000)};
        if (n % 5 < 3) { /* faces flat on the slab */
            b.convex.turn = a.convex.turn;
            slab = rotation_apply(&a.convex.turn, (struct vec3){0, n % 5 == 0 ? -1 : 1, 0});
        }
        gjk_support(&a.convex, slab, &on_a);
        gjk_support(&b.convex, vec3_scale(slab, -1.0), &on_b);
        b.convex.at = vec3_add(a.convex.at, vec3_add(vec3_sub(on_a, on_b), vec3_scale(slab, want)));
        place(&a, a.convex.at);
        place(&b, a.convex.at);
        struct gjk gjk = gjk_distance(&a.convex, &b.convex);
        if (!(fabs(gjk.distance_m - want) < SLACK_M) ||
            (gjk.distance_m > 0.0 &&
             !(apart(&a, &b, gjk.normal) > want - (want > 1e-6 ? SLACK_M : 1e-8))))
            fail_msg("pair %d: %.17g m, put at %.17g, its plane keeps %.17g", n, gjk.distance_m,
                     want, apart(&a, &b, gjk.normal));
    }
}

/* --- swapping ----------------------------------------------------------------------------------*/

static void test_swapping_the_bodies_changes_only_the_normals_sign(void **state)
{
    static struct solid a, b;
    uint64_t random = fixture_seed(312);
    (void)state;
    for (int n = 0; n < 10000; n++) {
        draw(&a, (enum sort)(n % 5), &random);
        draw(&b, (enum sort)(n / 5 % 5), &random);
        put_beside(&a, &b, n / 25 % 4, &random);
        struct gjk there = gjk_distance(&a.convex, &b.convex);
        struct gjk back = gjk_distance(&b.convex, &a.convex);
        assert_true(fabs(there.distance_m - back.distance_m) < SLACK_M);
        if (there.distance_m > 1e-6)
            assert_true(vec3_length(vec3_add(there.normal, back.normal)) < 1e-5);
    }
}

/* --- limits ------------------------------------------------------------------------------------*/

static void test_a_limit_gives_the_same_bits_or_a_lower_bound(void **state)
{
    static struct solid a, b;
    uint64_t random = fixture_seed(313), far = 0;
    (void)state;
    for (int n = 0; n < 10000; n++) {
        draw(&a, (enum sort)(n % 5), &random);
        draw(&b, (enum sort)(n / 5 % 5), &random);
        put_beside(&a, &b, n / 25 % 4, &random);
        place(&a, a.convex.at);
        place(&b, a.convex.at);
        double limit = n % 2 ? 0.0 : fixture_uniform(&random, 0.0, 0.02);
        struct gjk_start from = {.guess = {1, 0, 0}}, start = from;
        struct gjk all = gjk_distance_from(&a.convex, &b.convex, &from);
        struct gjk gjk = gjk_distance_within(&a.convex, &b.convex, limit, &start);
        far += gjk.distance_m > limit;
        if (gjk.distance_m > limit)
            assert_true(all.distance_m > limit && gjk.distance_m < all.distance_m + SLACK_M);
        else
            assert_memory_equal(&gjk, &all, offsetof(struct gjk, corner));
        struct vec3 normal = fixture_direction(&random);
        assert_true(apart(&a, &b, normal) < gjk_most_apart(&gjk, normal) + SLACK_M);
    }
    assert_in_range(far, 1000, 9000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_distance_is_that_of_the_nearest_features),
        cmocka_unit_test(test_big_small_and_thin_bodies_are_as_far_apart_as_they_were_put),
        cmocka_unit_test(test_swapping_the_bodies_changes_only_the_normals_sign),
        cmocka_unit_test(test_a_limit_gives_the_same_bits_or_a_lower_bound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
