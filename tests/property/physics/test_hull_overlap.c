/* The judge's separating axes against the collider's GJK, which it shares no code with: the hulls
 * of the shipped kinds in random places. SEED=n runs another set. */
#include "supervisor/physics/hull_overlap.h"

#include "collider/geometry/gjk.h"
#include "tests/support/fixture.h"
#include "world/entity/hull.h"
#include "world/maths/rotation.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define PAIRS  4000
#define TRIALS 12

static struct fixture f;
static struct hull_shape *shape;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    uint32_t hulls = f.view.world.counts.hulls;
    shape = calloc(hulls, sizeof *shape);
    for (uint32_t i = 0; i < hulls; i++)
        assert_int_equal(hull_shape_find(&shape[i], &f.view.world, &f.view.world.hulls[i]), 0);
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < f.view.world.counts.hulls; i++)
        hull_shape_free(&shape[i]);
    free(shape);
    fixture_close(&f);
    return 0;
}

/* A hull in a place, for both. */
struct placed {
    const struct hull_shape *shape;
    double heading, pitch, roll;
    struct vec3 at;
};

static struct placed random_hull(uint64_t *random)
{
    struct placed placed = {.shape = &shape[fixture_random(random) % f.view.world.counts.hulls]};
    placed.heading = fixture_uniform(random, 0.0, TWO_PI);
    placed.pitch = fixture_uniform(random, -HALF_PI, HALF_PI);
    placed.roll = fixture_uniform(random, -PI, PI);
    return placed;
}

static double gjk_gap(const struct placed *a, const struct placed *b)
{
    struct convex convex[2];
    for (int i = 0; i < 2; i++) {
        const struct placed *p = i ? b : a;
        convex[i] = (struct convex){
            .vertex = p->shape->vertex,
            .count = p->shape->vertices,
            .scale = 1.0,
            .turn = rotation_matrix(rotation_of(p->heading, p->pitch, p->roll)),
            .at = p->at,
        };
    }
    return gjk_distance(&convex[0], &convex[1]).distance_m;
}

static struct rigid_pose pose_of(const struct placed *p)
{
    return rigid_pose_of(p->at, p->heading, p->pitch, p->roll);
}

/* Returns the separation, and its axis in world axes. */
static double axis_gap(const struct placed *a, const struct placed *b, struct vec3 *world)
{
    const struct rigid_pose p = pose_of(a), q = pose_of(b);
    const struct relative_place place = hull_overlap_place(&p, &q, 1.0);
    struct vec3 axis = {0.0, 0.0, 0.0};
    double gap = hull_overlap_find(a->shape, b->shape, &place, 1e9, &axis);
    *world = rigid_pose_out(&p, axis);
    return gap;
}

static struct vec3 random_direction(uint64_t *random)
{
    for (;;) {
        struct vec3 v = {fixture_uniform(random, -1.0, 1.0), fixture_uniform(random, -1.0, 1.0),
                         fixture_uniform(random, -1.0, 1.0)};
        double length = vec3_length(v);
        if (length > 0.1 && length <= 1.0)
            return vec3_scale(v, 1.0 / length);
    }
}

/* A shift by the depth along the axis parts the hulls. No shift by less parts them, in any
 * direction. */
static void check_depth(const struct placed *a, struct placed b, double depth, struct vec3 axis,
                        uint64_t *random)
{
    const struct vec3 at = b.at;
    b.at = vec3_add(at, vec3_scale(axis, depth + 1e-6));
    assert_true(gjk_gap(a, &b) > 0.0);
    for (int i = 0; i < TRIALS; i++) {
        struct vec3 direction = i == 0 ? axis : random_direction(random);
        b.at = vec3_add(at, vec3_scale(direction, 0.999 * depth - 1e-6));
        assert_true(depth < 1e-5 || gjk_gap(a, &b) == 0.0);
    }
}

static void test_hulls_overlap_when_gjk_says_so(void **state)
{
    uint64_t random = fixture_seed(1);
    int deep = 0, far = 0;
    (void)state;
    for (int i = 0; i < PAIRS; i++) {
        struct placed a = random_hull(&random), b = random_hull(&random);
        double reach = a.shape->radius_m + b.shape->radius_m;
        struct vec3 axis, way = random_direction(&random);
        const struct rigid_pose p = pose_of(&a), q = pose_of(&b);
        b.at = vec3_sub(rigid_pose_out(&p, a.shape->centre), rigid_pose_out(&q, b.shape->centre));
        b.at = vec3_add(b.at, vec3_scale(way, fixture_uniform(&random, 0.0, reach)));
        double gap = axis_gap(&a, &b, &axis), gjk = gjk_gap(&a, &b);
        if (gap > 0.0 ? gjk < gap - 1e-8 : gjk > 1e-8)
            fail_msg("pair %d: %.12g by axes, %.12g by GJK", i, gap, gjk);
        deep += gap < 0.0;
        far += gap > 0.0;
        if (gap < 0.0)
            check_depth(&a, b, -gap, axis, &random);
    }
    assert_true(deep > PAIRS / 10 && far > PAIRS / 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_hulls_overlap_when_gjk_says_so)};
    return cmocka_run_group_tests(tests, open_world, close_world);
}
