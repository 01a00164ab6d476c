/* The ground under eight bodies is, to the bit, what one point at a time finds. */
#include "world/terrain/terrain_cache.h"

#include "tests/support/fixture.h"
#include "world/terrain/gridsquare.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define SIDE    401u
#define SPACING 125.0

static float posts[SIDE * SIDE];
static uint8_t cover[SIDE * SIDE];
static const struct terrain terrain = {.posts = posts,
                                       .cover = cover,
                                       .side = SIDE,
                                       .spacing_m = SPACING,
                                       .squares = GRIDSQUARES_DEFAULT_INIT};
static struct terrain_cache_entry patches[LANE_COUNT];

/* Anywhere, on posts and edges, outside the world. */
static double place(uint64_t *random)
{
    double metres = fixture_uniform(random, -500.0, WORLD_SIDE_DEFAULT_M + 500.0);
    switch (fixture_random(random) % 6) {
    case 0:
        return SPACING * floor(metres / SPACING);
    case 1:
        return SPACING * (floor(metres / SPACING) + 0.5);
    case 2:
        return metres < WORLD_SIDE_DEFAULT_M * 0.5 ? 0.0 : WORLD_SIDE_DEFAULT_M;
    default:
        return metres;
    }
}

static void check(const struct terrain_cache *footing, const union simd_lanes *x,
                  const union simd_lanes *z)
{
    union simd_lanes height;
    union lane_masks water;
    terrain_cache_heights(&terrain, footing, x, z, &height);
    terrain_cache_water(&terrain, footing, x, z, &water);
    for (int l = 0; l < LANE_COUNT; l++) {
        bool wet = cover_is_water(terrain_cover(&terrain, x->lane[l], z->lane[l]));
        assert_true(height.lane[l] == terrain_base_height(&terrain, x->lane[l], z->lane[l]));
        assert_int_equal(water.lane[l], wet ? -1 : 0);
    }
}

static void test_lanes_are_one_point_at_a_time(void **state)
{
    uint64_t random = fixture_seed(1);
    struct terrain_cache footing = {.patch = {NULL}};
    (void)state;
    fixture_roughen(posts, cover, SIDE * SIDE, &random);
    memset(patches, 0, sizeof patches);
    for (int l = 0; l < LANE_COUNT; l++)
        footing.patch[l] = &patches[l];
    union simd_lanes x, z, px, pz;
    for (int i = 0; i < 20000; i++) {
        for (int l = 0; l < LANE_COUNT; l++) {
            if (i % 4 == 0 || l % 3 == 0) { /* others stay, and so do their patches */
                x.lane[l] = place(&random);
                z.lane[l] = l % 4 == 0 ? x.lane[l] : place(&random);
            }
            double reach = i % 5 ? 60.0 : 600.0; /* within the patch, or far outside */
            px.lane[l] = x.lane[l] + fixture_uniform(&random, -reach, reach);
            pz.lane[l] = z.lane[l] + fixture_uniform(&random, -reach, reach);
        }
        terrain_cache_find(&terrain, &footing, &x, &z);
        check(&footing, &x, &z);
        check(&footing, &px, &pz);
    }
}

static void test_a_body_near_its_place_needs_its_patch_alone(void **state)
{
    uint64_t random = fixture_seed(2);
    struct terrain_cache footing = {.patch = {NULL}};
    union simd_lanes x, z, height, before;
    (void)state;
    fixture_roughen(posts, cover, SIDE * SIDE, &random);
    memset(patches, 0, sizeof patches);
    for (int l = 0; l < LANE_COUNT; l++) {
        footing.patch[l] = &patches[l];
        x.lane[l] = fixture_uniform(&random, 0.0, WORLD_SIDE_DEFAULT_M);
        z.lane[l] = fixture_uniform(&random, 0.0, WORLD_SIDE_DEFAULT_M);
    }
    terrain_cache_find(&terrain, &footing, &x, &z);
    for (int l = 0; l < LANE_COUNT; l++) /* less than half a cell */
        x.lane[l] = maths_clamp(x.lane[l] + fixture_uniform(&random, -62.0, 62.0), 0.0,
                                WORLD_SIDE_DEFAULT_M);
    terrain_cache_heights(&terrain, &footing, &x, &z, &before);
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        posts[i] = NAN;
    terrain_cache_heights(&terrain, &footing, &x, &z, &height);
    assert_memory_equal(&height, &before, sizeof height);
}

static void test_slopes_are_those_of_the_ground(void **state)
{
    uint64_t random = fixture_seed(5);
    struct terrain_cache_entry entry = {.held = 0};
    (void)state;
    fixture_roughen(posts, cover, SIDE * SIDE, &random);
    for (int i = 0; i < 50000; i++) {
        double x = place(&random), z = place(&random), reach = i % 5 ? 60.0 : 600.0;
        double px = x + fixture_uniform(&random, -reach, reach);
        double pz = z + fixture_uniform(&random, -reach, reach);
        double east, south, wanted_east, wanted_south;
        if (i % 7 > 0)
            (void)terrain_cache_bend(&terrain, &entry, x, z); /* fills it */
        terrain_cache_slopes(&terrain, &entry, px, pz, &east, &south);
        (void)terrain_base_plane(&terrain, px, pz, &wanted_east, &wanted_south);
        assert_true(east == wanted_east && south == wanted_south);
    }
}

/* A step on the ground along a line, and back, differ in height by no more than the slopes do. */
static void test_the_slopes_about_a_body_differ_by_no_more(void **state)
{
    uint64_t random = fixture_seed(4);
    struct terrain_cache footing = {.patch = {NULL}};
    union simd_lanes x, z, bend;
    double closest = 0.0;
    (void)state;
    fixture_roughen(posts, cover, SIDE * SIDE, &random);
    memset(patches, 0, sizeof patches);
    for (int l = 0; l < LANE_COUNT; l++)
        footing.patch[l] = &patches[l];
    for (int i = 0; i < 5000; i++) {
        for (int l = 0; l < LANE_COUNT; l++) {
            x.lane[l] = fixture_uniform(&random, 200.0, WORLD_SIDE_DEFAULT_M - 200.0);
            z.lane[l] = fixture_uniform(&random, 200.0, WORLD_SIDE_DEFAULT_M - 200.0);
        }
        terrain_cache_find(&terrain, &footing, &x, &z);
        terrain_cache_bends(&footing, &bend);
        for (int l = 0; l < LANE_COUNT; l++) {
            struct terrain_cache_entry entry = {.held = 0};
            double east = fixture_uniform(&random, -30.0, 30.0);
            double south = fixture_uniform(&random, -30.0, 30.0);
            double here = terrain_base_height(&terrain, x.lane[l], z.lane[l]);
            double there = terrain_base_height(&terrain, x.lane[l] + east, z.lane[l] + south);
            double back = terrain_base_height(&terrain, x.lane[l] - east, z.lane[l] - south);
            double share = fabs(there + back - 2.0 * here) /
                           maths_max(bend.lane[l] * sqrt(east * east + south * south), 1e-9);
            assert_true(terrain_cache_bend(&terrain, &entry, x.lane[l], z.lane[l]) == bend.lane[l]);
            assert_true(terrain_cache_bend(&terrain, &entry, x.lane[l], z.lane[l]) == bend.lane[l]);
            closest = maths_max(closest, share);
        }
    }
    assert_true(closest <= 1.0 && closest > 0.5);
}

/* A post in a thousand is wet. */
static void wet_few(uint64_t *random)
{
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        cover[i] = fixture_random(random) % 1000 == 0 ? COVER_LAKE : COVER_GRASS;
}

static void test_where_it_is_dry_no_point_near_is_wet(void **state)
{
    uint64_t random = fixture_seed(3);
    struct terrain_cache footing = {.patch = {NULL}};
    union simd_lanes x, z, reach;
    uint32_t dry = 0, wet = 0;
    (void)state;
    wet_few(&random);
    memset(patches, 0, sizeof patches);
    for (int i = 0; i < 20000; i++) {
        for (int l = 0; l < LANE_COUNT; l++) {
            footing.patch[l] = &patches[l];
            x.lane[l] = place(&random);
            z.lane[l] = place(&random);
            reach.lane[l] = fixture_uniform(&random, 0.0, 0.51 * SPACING);
        }
        terrain_cache_find(&terrain, &footing, &x, &z);
        bool is_dry = terrain_cache_dry(&terrain, &footing, &reach);
        for (int n = 0; n < 4 * LANE_COUNT; n++) { /* the corners that are as far as allowed */
            int l = n / 4;
            double px = x.lane[l] + (n & 1 ? reach.lane[l] : -reach.lane[l]);
            double pz = z.lane[l] + (n & 2 ? reach.lane[l] : -reach.lane[l]);
            bool is_wet = cover_is_water(terrain_cover(&terrain, px, pz));
            assert_false(is_dry && is_wet);
            wet += is_wet;
        }
        dry += is_dry;
        reach.lane[i % LANE_COUNT] = 0.6 * SPACING; /* more than it can know */
        assert_false(terrain_cache_dry(&terrain, &footing, &reach));
    }
    assert_true(dry > 10000 && wet > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lanes_are_one_point_at_a_time),
        cmocka_unit_test(test_a_body_near_its_place_needs_its_patch_alone),
        cmocka_unit_test(test_slopes_are_those_of_the_ground),
        cmocka_unit_test(test_the_slopes_about_a_body_differ_by_no_more),
        cmocka_unit_test(test_where_it_is_dry_no_point_near_is_wet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
