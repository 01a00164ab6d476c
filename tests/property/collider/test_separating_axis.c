/* Pairs that are not swept, because a plane keeps them apart, do not touch (thesis row 23). The
 * oracle is the sweep. SEED=n tries other pairs. */
#include "tests/support/steps.h"
#include "collider/geometry/time_of_impact.h"
#include "collider/narrow_phase/separating_axis.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define PAIRS 30000

static const char *const kinds[] = {"tank", "jeep", "truck", "helicopter"};

static struct fixture f;

static double uniform(uint64_t *random, double low, double high)
{
    return fixture_uniform(random, low, high);
}

/* A body of a random kind that moves and turns at random from `since` on. */
static struct swept_body random_body(uint64_t *random, double since)
{
    const struct world *world = &f.view.world;
    const struct kind *kind = steps_kind(&f, kinds[fixture_random(random) % 4]);
    double far = uniform(random, 0.0, 1.0) < 0.5 ? 0.3 : 20.0, turns = far > 1.0 ? 1.5 : 0.05;
    struct quat from = rotation_of(uniform(random, 0.0, TWO_PI), uniform(random, -0.3, 0.3),
                                   uniform(random, -0.3, 0.3));
    struct vec3 spin = {uniform(random, -turns, turns), uniform(random, -turns, turns),
                        uniform(random, -turns, turns)};
    return (struct swept_body){
        .hull = world->hulls + kind->first_hull,
        .hull_count = kind->hull_count,
        .outer = world->hulls + kind->outer_hull,
        .vertices = world->hull_vertices,
        .planes = world->hull_planes,
        .scale = 1.0,
        .bound_m = kind->bound_m,
        .path = {.at = {25000.0 + uniform(random, -6.0, 6.0), 100.0 + uniform(random, -2.0, 2.0),
                        25000.0 + uniform(random, -6.0, 6.0)},
                 .along = {uniform(random, -far, far), 0.05 * uniform(random, -far, far),
                           uniform(random, -far, far)},
                 .since = since},
        .from = from,
        .to = rotation_spun(from, spin, 1.0)};
}

static struct axis_side side_of(const struct swept_body *body, double time)
{
    struct axis_side side;
    axis_side_set(&side, body, rotation_rate(body->from, body->to), time);
    return side;
}

static void test_row_23_what_is_not_swept_does_not_touch(void **state)
{
    (void)state;
    uint64_t random = fixture_seed(23);
    uint32_t proved = 0, apart = 0;
    fixture_open(&f, "world = { seed = 1; };\ncollision = { shape = \"model\"; };\n");
    for (uint32_t i = 0; i < PAIRS; i++) {
        struct hull_contact impact;
        struct vec3 axis = {0.0, 0.0, 0.0};
        double time = i % 2 == 0 ? 0.0 : uniform(&random, 0.1, 0.9);
        struct swept_body a = random_body(&random, 0.0);
        struct swept_body b = random_body(&random, i % 4 == 1 ? time : 0.0);
        struct axis_side side_a = side_of(&a, time), side_b = side_of(&b, time);
        bool touch = time_of_impact_find(&a, &b, time, &impact);
        double least;
        bool proof = separating_axis_find(&side_a, &side_b, SKIN_M, true, &axis, &least);
        assert_false(touch && proof);
        assert_false(proof && least > time_of_impact_gap(&a, &b, time) + 1e-9);
        assert_false(proof && least > time_of_impact_gap(&a, &b, 1.0) + 1e-9);
        assert_false(proof && time_of_impact_gap(&a, &b, time) <= SKIN_M);
        proved += proof;
        apart += !touch;
    }
    print_message("%u of %u pairs do not touch; of %u there is a proof\n", apart, PAIRS, proved);
    assert_true(proved > apart / 3);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_23_what_is_not_swept_does_not_touch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
