/* Walks over the index of roads against looking at every stretch (row 4). */
#include "world/road_index.h"

#include "tests/support/fixture.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define POINTS 4000u
#define WALKS  500u

static struct road_point points[POINTS];
static uint32_t found[POINTS];

/* Roads of up to 16 points; a step leads up to 3 km, and some end beyond the edge of the world. */
static void lay_roads(uint64_t *seed)
{
    uint32_t left = 0, road = 0;
    double x = 0.0, z = 0.0;
    for (uint32_t i = 0; i < POINTS; i++, left--) {
        if (left == 0) {
            left = 1 + (uint32_t)fixture_uniform(seed, 0.0, 16.0);
            road++;
            x = fixture_uniform(seed, 0.0, WORLD_SIDE_DEFAULT_M);
            z = fixture_uniform(seed, 0.0, WORLD_SIDE_DEFAULT_M);
        }
        double step = i % 9 == 0 ? 3000.0 : 60.0;
        x += fixture_uniform(seed, -step, step);
        z += fixture_uniform(seed, -step, step);
        points[i] = (struct road_point){.x = x, .z = z, .road = road};
    }
}

static bool touches(uint32_t i, double x0, double z0, double x1, double z1)
{
    const struct road_point *a = &points[i], *b = a + 1;
    return i + 1 < POINTS && a->road == b->road && fmin((double)a->x, (double)b->x) <= x1 &&
           fmax((double)a->x, (double)b->x) >= x0 && fmin((double)a->z, (double)b->z) <= z1 &&
           fmax((double)a->z, (double)b->z) >= z0;
}

static void test_walk_finds_each_stretch_once(void **state)
{
    uint64_t seed = fixture_seed(4);
    struct road_index index;
    (void)state;
    lay_roads(&seed);
    assert_int_equal(road_index_make(&index, points, POINTS, WORLD_SIDE_DEFAULT_M), 0);
    for (uint32_t n = 0; n < WALKS; n++) {
        double side = n % 3 == 0 ? 10.0 : n % 3 == 1 ? 600.0 : WORLD_SIDE_DEFAULT_M;
        double x0 = fixture_uniform(&seed, -1000.0, WORLD_SIDE_DEFAULT_M);
        double z0 = fixture_uniform(&seed, -1000.0, WORLD_SIDE_DEFAULT_M);
        double x1 = x0 + fixture_uniform(&seed, 0.0, side);
        double z1 = z0 + fixture_uniform(&seed, 0.0, side);
        struct road_walk walk = road_index_walk(&index, x0, z0, x1, z1);
        uint32_t stretch;
        for (uint32_t i = 0; i < POINTS; i++)
            found[i] = 0;
        while (road_walk_next(&walk, &stretch))
            found[stretch]++;
        for (uint32_t i = 0; i < POINTS; i++)
            if (found[i] != touches(i, x0, z0, x1, z1))
                fail_msg("walk %u: stretch %u was found %u times", n, i, found[i]);
    }
    road_index_free(&index);
}

static void test_no_roads_are_an_index_too(void **state)
{
    struct road_index index;
    uint32_t stretch;
    (void)state;
    assert_int_equal(road_index_make(&index, points, 0, WORLD_SIDE_DEFAULT_M), 0);
    struct road_walk walk =
        road_index_walk(&index, 0.0, 0.0, WORLD_SIDE_DEFAULT_M, WORLD_SIDE_DEFAULT_M);
    assert_false(road_walk_next(&walk, &stretch));
    road_index_free(&index);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_walk_finds_each_stretch_once),
        cmocka_unit_test(test_no_roads_are_an_index_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
