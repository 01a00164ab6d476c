/* The monitor's map: the ground in bands, marks by rank, nothing outside, at every zoom. */
#include "clients/monitor/character_map.c" /* the unit tests are not linked with the processes */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define SIDE_M 50000.0

static struct character_map map;

/* Lowest in the west, highest in the east; the north-west cell is water. */
static const float heights[16] = {0, 10, 20, 40, 0, 10, 20, 40, 0, 10, 20, 40, 0, 10, 20, 40};
static const uint8_t water[16] = {1};
static const struct character_map_ground ground = {heights, water, 4, SIDE_M};
static const struct character_map_ground nothing = {NULL, NULL, 0, SIDE_M};
static const struct character_map_area whole = {0.5 * SIDE_M, 0.5 * SIDE_M, SIDE_M};

static void test_ground(void **state)
{
    (void)state;
    character_map_begin(&map, 4, 8, &whole, &ground);
    assert_memory_equal(map.cell[0], "~~ ..:^^", 8);
    assert_memory_equal(map.cell[3], "   ..:^^", 8);
}

static void test_ground_of_one_height(void **state)
{
    static const float flat[4] = {5, 5, 5, 5};
    static const uint8_t dry[4] = {0};
    static const struct character_map_ground level = {flat, dry, 2, SIDE_M};
    (void)state;
    character_map_begin(&map, 2, 4, &whole, &level);
    assert_memory_equal(map.cell[0], "    ", 4);
}

static void test_zoom_and_beyond(void **state)
{
    static const struct character_map_area corner = {0.0, 0.0, 0.5 * SIDE_M};
    (void)state;
    character_map_begin(&map, 4, 8, &corner, &ground);
    assert_memory_equal(map.cell[0], "''''''''", 8);
    assert_memory_equal(map.cell[3], "''''~~~~", 8);
    character_map_mark(&map, 1.0, 1.0, CHARACTER_MAP_BLUE);
    assert_int_equal(map.cell[2][4], CHARACTER_MAP_BLUE);
    character_map_mark(&map, 0.26 * SIDE_M, 1.0, CHARACTER_MAP_RED); /* east of it */
    assert_null(memchr(map.cell[2], CHARACTER_MAP_RED, 8));
}

static void test_sizes_are_cut(void **state)
{
    (void)state;
    character_map_begin(&map, 10000, 10000, &whole, &ground);
    assert_int_equal(map.rows, CHARACTER_MAP_ROWS_MAX);
    assert_int_equal(map.columns, CHARACTER_MAP_COLUMNS_MAX);
    character_map_begin(&map, -3, 0, &whole, &ground);
    assert_int_equal(map.rows, 0);
    character_map_mark(&map, 1.0, 1.0, CHARACTER_MAP_BLUE);
}

static void test_marks(void **state)
{
    (void)state;
    character_map_begin(&map, 10, 20, &whole, &nothing);
    character_map_mark(&map, 0.0, 0.0, CHARACTER_MAP_BLUE);
    assert_int_equal(map.cell[0][0], CHARACTER_MAP_BLUE);
    static const char marks[] = {CHARACTER_MAP_WRECK,    CHARACTER_MAP_RED, CHARACTER_MAP_NEUTRAL,
                                 CHARACTER_MAP_BLUE,     CHARACTER_MAP_RED, CHARACTER_MAP_MUNITION,
                                 CHARACTER_MAP_SELECTED, CHARACTER_MAP_BLUE};
    static const char shown[] = {CHARACTER_MAP_WRECK,    CHARACTER_MAP_RED,
                                 CHARACTER_MAP_RED,      CHARACTER_MAP_BOTH,
                                 CHARACTER_MAP_BOTH,     CHARACTER_MAP_MUNITION,
                                 CHARACTER_MAP_SELECTED, CHARACTER_MAP_SELECTED};
    for (size_t i = 0; i < sizeof marks; i++) {
        character_map_mark(&map, 49999.9, 49999.9, marks[i]);
        assert_int_equal(map.cell[9][19], shown[i]);
    }
}

static void test_outside_is_left_out(void **state)
{
    static const double outside[] = {-0.1, SIDE_M, 1e300, -1e300, NAN, INFINITY};
    static struct character_map before;
    (void)state;
    character_map_begin(&map, 10, 20, &whole, &nothing);
    before = map;
    for (size_t i = 0; i < sizeof outside / sizeof outside[0]; i++) {
        character_map_mark(&map, outside[i], 1.0, CHARACTER_MAP_BLUE);
        character_map_mark(&map, 1.0, outside[i], CHARACTER_MAP_BLUE);
    }
    assert_memory_equal(&map, &before, sizeof map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ground),          cmocka_unit_test(test_ground_of_one_height),
        cmocka_unit_test(test_zoom_and_beyond), cmocka_unit_test(test_sizes_are_cut),
        cmocka_unit_test(test_marks),           cmocka_unit_test(test_outside_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
