/* Neighbours against a look at every pair, and walls against a look at every object. */
#include "supervisor/physics/neighbour_pairs.h"

#include "tests/support/fixture.h"
#include "world/entity/kind.h"
#include "world/terrain/fixed.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define BALLS 400
#define WALLS 500

static bool meet(const struct neighbour_ball *a, struct vec3 b, double reach)
{
    double most = a->reach_m + reach;
    return fabs(a->at.x - b.x) <= most && fabs(a->at.y - b.y) <= most &&
           fabs(a->at.z - b.z) <= most;
}

static struct neighbour_ball random_ball(uint64_t *random, uint32_t body, double wide)
{
    struct neighbour_ball ball = {.reach_m = fixture_uniform(random, 0.5, 8.0), .body = body};
    ball.at = (struct vec3){25000.0 + fixture_uniform(random, -wide, wide),
                            100.0 + fixture_uniform(random, -10.0, 10.0),
                            25000.0 + fixture_uniform(random, -wide, wide)};
    return ball;
}

static void test_pairs_are_those_of_all_pairs(void **state)
{
    uint64_t random = fixture_seed(3);
    struct neighbour_ball ball[BALLS], sorted[BALLS];
    struct neighbour_pairs pairs = {0};
    uint32_t wanted = 0;
    (void)state;
    for (uint32_t i = 0; i < BALLS; i++)
        sorted[i] = ball[i] = random_ball(&random, i, 100.0);
    assert_int_equal(neighbour_pairs_find(&pairs, sorted, BALLS), 0);
    for (uint32_t i = 0; i < BALLS; i++) {
        for (uint32_t j = 0; j < i; j++)
            wanted += meet(&ball[i], ball[j].at, ball[j].reach_m);
    }
    assert_true(wanted > 100);
    assert_int_equal(pairs.count, wanted);
    for (uint32_t i = 0; i < pairs.count; i++) {
        const struct neighbour_ball *b = &ball[pairs.pair[i].b];
        assert_true(meet(&ball[pairs.pair[i].a], b->at, b->reach_m));
    }
    neighbour_pairs_free(&pairs);
}

static void test_walls_are_those_of_all_objects(void **state)
{
    static struct fixed_object fixed[WALLS];
    const struct kind kinds[2] = {{.rigidity = 0.5, .radius_m = 2.0, .bound_m = 3.0},
                                  {.rigidity = 0.05, .radius_m = 2.0, .bound_m = 3.0}};
    const struct world world = {.kinds = kinds, .fixed = fixed, .counts = {.fixed = WALLS}};
    uint64_t random = fixture_seed(4);
    struct neighbour_pairs pairs = {0};
    struct wall_grid grid;
    uint32_t wanted = 0, found = 0;
    (void)state;
    for (int i = 0; i < WALLS; i++)
        fixed[i] = (struct fixed_object){.x = 25000.0 + fixture_uniform(&random, -100.0, 100.0),
                                         .y = 100.0f,
                                         .z = 25000.0 + fixture_uniform(&random, -100.0, 100.0),
                                         .radius_m = (float)fixture_uniform(&random, 1.0, 30.0),
                                         .kind = (uint16_t)(i % 2)};
    assert_int_equal(wall_grid_make(&grid, &world), 0);
    for (uint32_t i = 0; i < BALLS; i++) {
        struct neighbour_ball ball = random_ball(&random, i, 120.0);
        pairs.count = 0;
        assert_int_equal(wall_grid_find(&grid, &world, &ball, &pairs), 0);
        found += pairs.count;
        for (int j = 0; j < WALLS; j += 2) {
            struct vec3 at = {fixed[j].x, (double)fixed[j].y, fixed[j].z};
            wanted += meet(&ball, at, 1.5 * (double)fixed[j].radius_m);
        }
        for (uint32_t j = 0; j < pairs.count; j++)
            assert_int_equal(fixed[pairs.pair[j].b].kind, 0);
    }
    assert_true(wanted > 100);
    assert_int_equal(found, wanted);
    neighbour_pairs_free(&pairs);
    wall_grid_free(&grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pairs_are_those_of_all_pairs),
        cmocka_unit_test(test_walls_are_those_of_all_objects),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
