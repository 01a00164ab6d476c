/* The memory of gaps between pairs of bodies. SEED=n tries other pairs. */
#include "collider/narrow_phase/gap_memory.h"

#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define PAIRS 100
#define MOVES 10  /* of each pair, after it was measured */
#define FAR_M 0.3 /* gaps are measured up to this */

static const struct pair pair = {3, 5};
static struct fixture f;
static struct gap_memory memory;

static int open_memory(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; };\ncollision = { shape = \"model\"; };");
    return gap_memory_init(&memory, &f.view.world);
}

static int close_memory(void **state)
{
    (void)state;
    gap_memory_free(&memory);
    fixture_close(&f);
    return 0;
}

/* Returns a tank that stands so far to the east, with this heading. */
static struct swept_body tank_at(double east_m, double heading_rad)
{
    const struct world *world = &f.view.world;
    const struct kind *kind = steps_kind(&f, "tank");
    struct quat turn = rotation_of(heading_rad, 0.0, 0.0);
    return (struct swept_body){.hull = world->hulls + kind->first_hull,
                               .hull_count = kind->hull_count,
                               .outer = world->hulls + kind->outer_hull,
                               .vertices = world->hull_vertices,
                               .planes = world->hull_planes,
                               .scale = 1.0,
                               .bound_m = kind->bound_m,
                               .path = {.at = {20000.0 + east_m, 100.0, 20000.0}},
                               .from = turn,
                               .to = turn};
}

static void measure(const struct swept_body *a, const struct swept_body *b)
{
    gap_memory_note(&memory, &pair, a, b, time_of_impact_gap_up_to(a, b, 0.0, FAR_M), FAR_M);
    gap_memory_settle(&memory);
}

static void test_an_unknown_pair_may_be_as_near_or_far_as_any(void **state)
{
    (void)state;
    struct swept_body a = tank_at(0.0, 0.0), b = tank_at(10.0, 0.0);
    struct gap_bounds gap = gap_memory_recall(&memory, &pair, &a, &b);
    assert_true(gap.least_m == 0.0 && gap.most_m == INFINITY);
    assert_true(gap_memory_wants(&memory, &pair));
}

static void test_a_gap_is_known_from_the_next_frame_on(void **state)
{
    (void)state;
    struct swept_body a = tank_at(0.0, 0.0), b = tank_at(10.0, 0.0);
    gap_memory_note(&memory, &pair, &a, &b, 0.1, FAR_M);
    assert_true(gap_memory_recall(&memory, &pair, &a, &b).least_m == 0.0);
    gap_memory_settle(&memory);
    struct gap_bounds gap = gap_memory_recall(&memory, &pair, &a, &b);
    assert_true(gap.least_m > 0.0999 && gap.least_m <= 0.1);
    assert_true(gap.most_m < 0.1001 && gap.most_m >= 0.1);
    const struct pair other = {3, 6};
    assert_true(gap_memory_recall(&memory, &other, &a, &b).least_m == 0.0);
}

static void test_a_great_gap_has_no_upper_bound(void **state)
{
    (void)state;
    struct swept_body a = tank_at(0.0, 0.0), b = tank_at(30.0, 0.0);
    measure(&a, &b);
    struct gap_bounds gap = gap_memory_recall(&memory, &pair, &a, &b);
    assert_true(gap.least_m > 0.29 && gap.least_m <= FAR_M && gap.most_m == INFINITY);
}

/* A gap says nothing about bodies with other hulls, or whose gun points elsewhere. */
static void test_another_shape_has_another_gap(void **state)
{
    (void)state;
    struct swept_body a = tank_at(0.0, 0.0), b = tank_at(30.0, 0.0), c = b, d = b;
    measure(&a, &b);
    c.hull++;
    d.turret.gun = 0.1;
    assert_true(gap_memory_recall(&memory, &pair, &a, &c).least_m == 0.0);
    assert_true(gap_memory_recall(&memory, &pair, &a, &d).least_m == 0.0);
    assert_true(gap_memory_recall(&memory, &pair, &d, &b).least_m == 0.0);
}

static void test_a_pair_is_measured_again_after_some_frames(void **state)
{
    (void)state;
    struct swept_body a = tank_at(0.0, 0.0), b = tank_at(10.0, 0.0);
    uint32_t frames = 0;
    for (measure(&a, &b); !gap_memory_wants(&memory, &pair); frames++)
        gap_memory_settle(&memory);
    assert_in_range(frames, 2, 10);
}

/* Turns a body by up to far_rad about each axis, and moves it by up to far_m along each. */
static void move(uint64_t *random, double far_rad, double far_m, struct swept_body *body)
{
    struct vec3 spin = {fixture_uniform(random, -far_rad, far_rad),
                        fixture_uniform(random, -far_rad, far_rad),
                        fixture_uniform(random, -far_rad, far_rad)};
    struct vec3 by = {fixture_uniform(random, -far_m, far_m),
                      fixture_uniform(random, -far_m, far_m),
                      fixture_uniform(random, -far_m, far_m)};
    body->path.at = vec3_add(body->path.at, by);
    body->from = body->to = rotation_spun(body->from, spin, 1.0);
}

/* Turns one of the bodies, or moves both: each part of the bounds is needed by itself. */
static void move_some(uint64_t *random, uint32_t which, struct swept_body *a, struct swept_body *b)
{
    if (which < 2) {
        move(random, 0.02, 0.0, which == 0 ? a : b);
    } else {
        move(random, 0.0, 0.03, a);
        move(random, 0.0, 0.03, b);
    }
}

static void test_the_gap_is_within_its_bounds_wherever_the_bodies_go(void **state)
{
    (void)state;
    uint64_t random = fixture_seed(21);
    uint32_t shown = 0;
    for (uint32_t i = 0; i < PAIRS; i++) {
        struct swept_body a = tank_at(0.0, fixture_uniform(&random, 0.0, TWO_PI));
        struct swept_body b =
            tank_at(fixture_uniform(&random, 3.0, 9.0), fixture_uniform(&random, 0.0, TWO_PI));
        measure(&a, &b);
        for (uint32_t n = 0; n < MOVES; n++) {
            move_some(&random, i % 3, &a, &b);
            struct gap_bounds gap = gap_memory_recall(&memory, &pair, &a, &b);
            double real_m = time_of_impact_gap(&a, &b, 0.0);
            assert_true(gap.least_m <= real_m && real_m <= gap.most_m);
            shown += gap.least_m > 0.0;
        }
    }
    assert_true(shown > PAIRS);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_memory, close_memory)
    const struct CMUnitTest tests[] = {
        TEST(test_an_unknown_pair_may_be_as_near_or_far_as_any),
        TEST(test_a_gap_is_known_from_the_next_frame_on),
        TEST(test_a_great_gap_has_no_upper_bound),
        TEST(test_another_shape_has_another_gap),
        TEST(test_a_pair_is_measured_again_after_some_frames),
        TEST(test_the_gap_is_within_its_bounds_wherever_the_bodies_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
