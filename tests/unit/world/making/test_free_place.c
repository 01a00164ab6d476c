/* Places for vehicles: on ground that suits them, clear of each other and of what stands there. */
#include "world/making/free_place.h"

#include "tests/support/fixture.h"
#include "world/terrain/fixed_index.h"
#include "world/terrain/gridsquare.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define SIDE    401u
#define SPACING 125.0
#define TREES   400

static float posts[SIDE * SIDE];
static uint8_t cover[SIDE * SIDE];
static const struct terrain terrain = {.posts = posts,
                                       .cover = cover,
                                       .side = SIDE,
                                       .spacing_m = SPACING,
                                       .squares = GRIDSQUARES_DEFAULT_INIT};
static struct fixed_object trees[TREES];
static uint32_t *reach_start, *reach;
static struct free_place place;

static const struct kind tank = {.domain = DOMAIN_LAND, .radius_m = 3.0, .max_slope_rad = 0.5};
static const struct kind ship = {.domain = DOMAIN_SEA, .radius_m = 60.0};
static const struct kind jet = {.domain = DOMAIN_AIR, .radius_m = 8.0};
/* Its gun reaches out of its sphere, as the oak's crown does. */
static const struct kind gun = {
    .domain = DOMAIN_LAND, .radius_m = 3.0, .level_m = 5.75, .max_slope_rad = 0.5};
static const struct kind bare = {.domain = DOMAIN_FIXED, .radius_m = 2.0};
static const struct kind oak = {.domain = DOMAIN_FIXED, .radius_m = 1.6, .level_m = 4.0};

/* West of 20 km and south of 5 km it is sea, with an island at (10 km, 10 km); east of 40 km a wall
 * of 45 degrees; trees stand around (30 km, 30 km). */
static int make_ground(void **state)
{
    uint64_t random = 5;
    (void)state;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        uint32_t column = i % SIDE, row = i / SIDE;
        bool island = column == 80 && row == 80;
        cover[i] = column < 160 && row >= 40 && !island ? COVER_SEA : COVER_GRASS;
        posts[i] = column > 320 ? 125.0f * (float)(column - 320) : 0.0f;
    }
    for (int i = 0; i < TREES; i++)
        trees[i] = (struct fixed_object){.x = fixture_uniform(&random, 30000.0, 30300.0),
                                         .z = fixture_uniform(&random, 30000.0, 30300.0),
                                         .radius_m = 2.0f};
    if (fixed_index_build(&GRIDSQUARES_DEFAULT, trees, TREES, &bare, &reach_start, &reach) != 0)
        return -1;
    return free_place_init(&place, &terrain, trees, &bare, reach_start, reach, 1);
}

static int drop_ground(void **state)
{
    (void)state;
    free_place_free(&place);
    free(reach_start);
    free(reach);
    return 0;
}

static void check_all(const struct kind *kind, const struct area *area, uint32_t count,
                      bool (*suits)(double x, double z))
{
    for (uint32_t i = 0; i < count; i++) {
        double x, z;
        assert_int_equal(free_place_find(&place, area, kind, i, &x, &z), 0);
        assert_true(x >= area->x0 && x <= area->x1 && z >= area->z0 && z <= area->z1);
        if (!suits(x, z))
            fail_msg("number %u at (%.1f, %.1f)", i, x, z);
    }
}

static bool dry_and_level(double x, double z)
{
    bool wet = x < 159.5 * SPACING && z > 39.5 * SPACING &&
               !(fabs(x - 10000.0) <= SPACING / 2 && fabs(z - 10000.0) <= SPACING / 2);
    return !wet && x < 320.0 * SPACING + 1.0;
}

static bool open_water(double x, double z)
{
    return x + 250.0 < 159.5 * SPACING + 1e-6 && z - 250.0 > 39.5 * SPACING - 1e-6;
}

static bool anywhere(double x, double z)
{
    (void)x, (void)z;
    return true;
}

static void test_land_vehicles_start_on_dry_ground_that_they_climb(void **state)
{
    const struct area all = {0.0, 0.0, WORLD_SIDE_DEFAULT_M, WORLD_SIDE_DEFAULT_M};
    (void)state;
    check_all(&tank, &all, 2000, dry_and_level);
}

static void test_ships_start_on_water_with_room_to_turn(void **state)
{
    const struct area coast = {18000.0, 0.0, 22000.0, WORLD_SIDE_DEFAULT_M};
    const struct area north = {1000.0, 3000.0, 9000.0, 6000.0};
    const struct area island = {9950.0, 9950.0, 10050.0, 10050.0};
    double x, z;
    (void)state;
    check_all(&ship, &coast, 500, open_water);
    check_all(&ship, &north, 500, open_water);
    assert_int_equal(free_place_find(&place, &island, &ship, 0, &x, &z), -1);
}

static void test_aircraft_start_anywhere_in_their_area(void **state)
{
    const struct area corner = {40000.0, 0.0, WORLD_SIDE_DEFAULT_M, 1000.0};
    (void)state;
    check_all(&jet, &corner, 500, anywhere);
}

static void test_places_do_not_touch_each_other(void **state)
{
    const struct area yard = {25000.0, 25000.0, 25300.0, 25300.0};
    double x[200], z[200];
    (void)state;
    for (uint32_t i = 0; i < 200; i++) {
        assert_int_equal(free_place_find(&place, &yard, &tank, i, &x[i], &z[i]), 0);
        assert_int_equal(free_place_take(&place, x[i], z[i], tank.radius_m), 0);
        for (uint32_t j = 0; j < i; j++)
            assert_true(hypot(x[i] - x[j], z[i] - z[j]) >= 2 * tank.radius_m + 1.0);
    }
}

/* A large neighbour is seen from squares away. */
static void test_a_large_neighbour_is_seen_across_squares(void **state)
{
    const struct area yard = {25000.0, 25000.0, 25600.0, 25600.0};
    (void)state;
    assert_int_equal(free_place_take(&place, 25300.0, 25300.0, 200.0), 0);
    for (uint32_t i = 0; i < 500; i++) {
        double x, z;
        assert_int_equal(free_place_find(&place, &yard, &tank, i, &x, &z), 0);
        assert_true(hypot(x - 25300.0, z - 25300.0) >= 203.0);
    }
}

static void test_land_vehicles_start_clear_of_objects(void **state)
{
    const struct area wood = {30000.0, 30000.0, 30300.0, 30300.0};
    (void)state;
    for (uint32_t i = 0; i < 100; i++) {
        double x, z;
        assert_int_equal(free_place_find(&place, &wood, &tank, i, &x, &z), 0);
        for (int t = 0; t < TREES; t++)
            assert_true(hypot(x - trees[t].x, z - trees[t].z) >= tank.radius_m + 2.0);
    }
}

/* Row 38: what sticks out of a sphere keeps its distance too; the trees are 2 / 1.6 as large as
 * their kind. */
static void test_hulls_keep_clear_of_each_other(void **state)
{
    const struct area wood = {30000.0, 30000.0, 30300.0, 30300.0};
    const double crown = 4.0 * 2.0 / 1.6;
    struct free_place other;
    double x[40], z[40];
    (void)state;
    assert_int_equal(free_place_init(&other, &terrain, trees, &oak, reach_start, reach, 1), 0);
    for (uint32_t i = 0; i < 40; i++) {
        assert_int_equal(free_place_find(&other, &wood, &gun, i, &x[i], &z[i]), 0);
        assert_int_equal(free_place_take(&other, x[i], z[i], fixed_index_of_kind(&gun)), 0);
        for (int t = 0; t < TREES; t++)
            assert_true(hypot(x[i] - trees[t].x, z[i] - trees[t].z) >= gun.level_m + crown);
        for (uint32_t j = 0; j < i; j++)
            assert_true(hypot(x[i] - x[j], z[i] - z[j]) >= 2 * gun.level_m);
    }
    free_place_free(&other);
}

static void test_no_place_is_said(void **state)
{
    const struct area sea = {1000.0, 20000.0, 2000.0, 21000.0};
    const struct area lot = {25000.0, 25000.0, 25020.0, 25020.0};
    double x, z;
    (void)state;
    assert_int_equal(free_place_find(&place, &sea, &tank, 0, &x, &z), -1);
    uint32_t found = 0;
    while (found < 100 && free_place_find(&place, &lot, &tank, found, &x, &z) == 0) {
        assert_int_equal(free_place_take(&place, x, z, tank.radius_m), 0);
        found++;
    }
    assert_in_range(found, 4, 25); /* 20 m by 20 m is full of circles 7 m apart */
}

static void test_same_seed_same_places(void **state)
{
    const struct area all = {0.0, 0.0, WORLD_SIDE_DEFAULT_M, WORLD_SIDE_DEFAULT_M};
    struct free_place other;
    double x, z, again_x, again_z, other_x, other_z;
    (void)state;
    assert_int_equal(free_place_init(&other, &terrain, trees, &bare, reach_start, reach, 2), 0);
    assert_int_equal(free_place_find(&place, &all, &tank, 7, &x, &z), 0);
    assert_int_equal(free_place_find(&place, &all, &tank, 7, &again_x, &again_z), 0);
    assert_int_equal(free_place_find(&other, &all, &tank, 7, &other_x, &other_z), 0);
    assert_true(x == again_x && z == again_z);
    assert_true(x != other_x && z != other_z);
    free_place_free(&other);
}

static void test_no_vehicle_starts_at_the_worlds_edge(void **state)
{
    const struct area corner = {49800.0, 0.0, WORLD_SIDE_DEFAULT_M, 200.0};
    (void)state;
    for (uint32_t i = 0; i < 500; i++) {
        double x, z;
        assert_int_equal(free_place_find(&place, &corner, &jet, i, &x, &z), 0);
        assert_true(x <= WORLD_SIDE_DEFAULT_M - 50.0 && z >= 50.0);
    }
}

/* An area that is all edge still holds its vehicles, and not all on one point. */
static void test_area_along_the_edge_holds_its_vehicles(void **state)
{
    const struct area strips[] = {{0.0, 20000.0, 30.0, 30000.0},
                                  {49980.0, 20000.0, WORLD_SIDE_DEFAULT_M, 30000.0},
                                  {20000.0, 49980.0, 30000.0, WORLD_SIDE_DEFAULT_M}};
    (void)state;
    for (size_t i = 0; i < sizeof strips / sizeof strips[0]; i++)
        check_all(&jet, &strips[i], 100, anywhere);
}

/* A place that somebody names is taken as it is, but for the ground itself. */
static void test_ships_are_for_water_and_what_drives_for_land(void **state)
{
    (void)state;
    assert_true(free_place_carries(&terrain, &ship, 5000.0, 20000.0));
    assert_false(free_place_carries(&terrain, &ship, 30000.0, 20000.0));
    assert_false(free_place_carries(&terrain, &tank, 5000.0, 20000.0));
    assert_true(free_place_carries(&terrain, &tank, 30000.0, 20000.0));
    assert_true(free_place_carries(&terrain, &tank, 45000.0, 20000.0)); /* however steep */
    assert_true(free_place_carries(&terrain, &jet, 5000.0, 20000.0));
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_ground, drop_ground)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_land_vehicles_start_on_dry_ground_that_they_climb),
        TEST(test_ships_start_on_water_with_room_to_turn),
        TEST(test_aircraft_start_anywhere_in_their_area),
        TEST(test_places_do_not_touch_each_other),
        TEST(test_a_large_neighbour_is_seen_across_squares),
        TEST(test_land_vehicles_start_clear_of_objects),
        TEST(test_hulls_keep_clear_of_each_other),
        TEST(test_no_place_is_said),
        TEST(test_same_seed_same_places),
        TEST(test_no_vehicle_starts_at_the_worlds_edge),
        TEST(test_area_along_the_edge_holds_its_vehicles),
        TEST(test_ships_are_for_water_and_what_drives_for_land),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
