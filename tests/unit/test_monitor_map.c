/* The monitor's map: the ground in bands, marks by rank, nothing outside. */
#include "monitor/map.c" /* the unit tests are not linked with the processes */

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SIDE_M 50000.0

static struct map map;

/* Lowest in the west, highest in the east; the north-west cell is water. */
static const float heights[16] = {0, 10, 20, 40, 0, 10, 20, 40, 0, 10, 20, 40, 0, 10, 20, 40};
static const uint8_t water[16] = {1};

static void test_ground(void **state)
{
    (void)state;
    map_ground(&map, 4, 8, heights, water, 4);
    assert_memory_equal(map.cell[0], "~~..::^^", 8);
    assert_memory_equal(map.cell[3], "  ..::^^", 8);
}

static void test_ground_of_one_height(void **state)
{
    static const float flat[4] = {5, 5, 5, 5};
    static const uint8_t dry[4] = {0};
    (void)state;
    map_ground(&map, 2, 2, flat, dry, 2);
    assert_memory_equal(map.cell[0], "  ", 2);
}

static void test_sizes_are_cut(void **state)
{
    (void)state;
    map_ground(&map, 10000, 10000, heights, water, 4);
    assert_int_equal(map.rows, MAP_ROWS_MAX);
    assert_int_equal(map.columns, MAP_COLUMNS_MAX);
    map_ground(&map, -3, 0, heights, water, 4);
    assert_int_equal(map.rows, 0);
    map_mark(&map, 1.0, 1.0, SIDE_M, MAP_BLUE);
}

static void test_marks(void **state)
{
    (void)state;
    map_ground(&map, 10, 20, NULL, NULL, 0);
    map_mark(&map, 0.0, 0.0, SIDE_M, MAP_BLUE);
    assert_int_equal(map.cell[0][0], MAP_BLUE);
    map_mark(&map, 49999.9, 49999.9, SIDE_M, MAP_WRECK);
    assert_int_equal(map.cell[9][19], MAP_WRECK);
    map_mark(&map, 49999.9, 49999.9, SIDE_M, MAP_RED);
    assert_int_equal(map.cell[9][19], MAP_RED);
    map_mark(&map, 49999.9, 49999.9, SIDE_M, MAP_NEUTRAL);
    assert_int_equal(map.cell[9][19], MAP_RED);
    map_mark(&map, 49999.9, 49999.9, SIDE_M, MAP_BLUE);
    assert_int_equal(map.cell[9][19], MAP_BOTH);
    map_mark(&map, 49999.9, 49999.9, SIDE_M, MAP_RED);
    assert_int_equal(map.cell[9][19], MAP_BOTH);
    map_mark(&map, 49999.9, 49999.9, SIDE_M, MAP_MUNITION);
    assert_int_equal(map.cell[9][19], MAP_MUNITION);
}

static void test_outside_is_left_out(void **state)
{
    static const double outside[] = {-0.1, SIDE_M, 1e300, -1e300, NAN, INFINITY};
    struct map before;
    (void)state;
    map_ground(&map, 10, 20, NULL, NULL, 0);
    before = map;
    for (size_t i = 0; i < sizeof outside / sizeof outside[0]; i++) {
        map_mark(&map, outside[i], 100.0, SIDE_M, MAP_RED);
        map_mark(&map, 100.0, outside[i], SIDE_M, MAP_RED);
    }
    assert_memory_equal(map.cell, before.cell, sizeof map.cell);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ground),
        cmocka_unit_test(test_ground_of_one_height),
        cmocka_unit_test(test_sizes_are_cut),
        cmocka_unit_test(test_marks),
        cmocka_unit_test(test_outside_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
