/* Queries of the stream's clients: valid ones, and the reasons for refusing others. */
#include "renderer/output/query.h"

#include "tests/support/fixture.h"
#include "world/maths/random.h"
#include "world/terrain/gridsquare.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define TRIES 20000

static struct query_picture picture;
static struct query_map map;
static struct error_text error;

static int take_picture(const char *key, const char *value)
{
    return query_picture_take(&picture, key, value, &error);
}

static void test_what_does_not_come_is_as_usual(void **state)
{
    (void)state;
    query_picture_begin(&picture);
    assert_int_equal(picture.key.view, VIEW_CHASE);
    assert_int_equal(picture.key.vehicle, 0);
    assert_int_equal(picture.key.width, 640);
    assert_true(picture.key.bar);
    assert_false(picture.after_given);
    query_map_begin(&map, WORLD_SIDE_DEFAULT_M);
    assert_true(map.x == 0.5 * WORLD_SIDE_DEFAULT_M && map.metres == WORLD_SIDE_DEFAULT_M);
}

static void test_a_whole_query(void **state)
{
    (void)state;
    query_picture_begin(&picture);
    assert_int_equal(take_picture("view", "inside"), 0);
    assert_int_equal(take_picture("vehicle", "4294967295"), 0);
    assert_int_equal(take_picture("size", "1920x1080"), 0);
    assert_int_equal(take_picture("after", "0"), 0);
    assert_int_equal(take_picture("bar", "0"), 0);
    assert_int_equal(picture.key.view, VIEW_INSIDE);
    assert_true(picture.key.vehicle == UINT32_MAX);
    assert_int_equal(picture.key.width, 1920);
    assert_int_equal(picture.key.height, 1080);
    assert_true(picture.after_given && picture.after == 0 && !picture.key.bar);
    query_map_begin(&map, WORLD_SIDE_DEFAULT_M);
    assert_int_equal(query_map_take(&map, "x", "-1e3", &error), 0);
    assert_int_equal(query_map_take(&map, "z", "41234.5", &error), 0);
    assert_int_equal(query_map_take(&map, "metres", "100", &error), 0);
    assert_int_equal(query_map_take(&map, "size", "64x64", &error), 0);
    assert_true(map.x == -1000.0 && map.z == 41234.5 && map.metres == 100.0);
    assert_int_equal(map.height, 64);
}

static void test_what_is_wrong_is_said(void **state)
{
    static const struct {
        const char *key, *value, *says;
    } rows[] = {
        {"view", "map", "view=map: is chase, inside, orbit or overhead"},
        {"view", "", "is chase"},
        {"view", NULL, "view has no value"},
        {"vehicle", "-1", "is a vehicle's number"},
        {"vehicle", "4294967296", "is a vehicle's number"},
        {"vehicle", "99999999999999999999999999", "is a vehicle's number"},
        {"vehicle", "17 ", "vehicle=17?: is"},
        {"size", "63x64", "from 64x64 to 1920x1080"},
        {"size", "1921x64", "from 64x64"},
        {"size", "64x1081", "from 64x64"},
        {"size", "640", "is WIDTHxHEIGHT"},
        {"size", "640x360x2", "is WIDTHxHEIGHT"},
        {"size", "x", "is WIDTHxHEIGHT"},
        {"after", "-1", "as in X-Picture"},
        {"after", "18446744073709551615", "as in X-Picture"},
        {"bar", "2", "is 0 or 1"},
        {"colour", "red", "colour is none of view, vehicle, size, after, bar"},
        {"\x1b[2J\n<script>", "", "?[2J?<script> is none of"},
        {"a_very_long_key_that_goes_on_and_on", "", "a_very_long_key_that_go is none of"},
    };
    static const struct {
        const char *key, *value, *says;
    } places[] = {
        {"x", "nan", "is a place in metres"},   {"x", "inf", "is a place in metres"},
        {"x", "0x10", "is a place in metres"},  {"z", "1e9", "is a place in metres"},
        {"z", "", "is a place in metres"},      {"metres", "0", "from 100 to 200000"},
        {"metres", "-5", "from 100 to 200000"}, {"metres", "1e999", "from 100 to 200000"},
        {"metres", "1e", "from 100 to 200000"}, {"view", "chase", "view is none of x, z"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        query_picture_begin(&picture);
        assert_int_equal(take_picture(rows[i].key, rows[i].value), -1);
        if (strstr(error.text, rows[i].says) == NULL)
            fail_msg("\"%s\" does not say \"%s\"", error.text, rows[i].says);
    }
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        query_map_begin(&map, WORLD_SIDE_DEFAULT_M);
        assert_int_equal(query_map_take(&map, places[i].key, places[i].value, &error), -1);
        if (strstr(error.text, places[i].says) == NULL)
            fail_msg("\"%s\" does not say \"%s\"", error.text, places[i].says);
    }
}

static void test_nothing_comes_twice(void **state)
{
    (void)state;
    query_picture_begin(&picture);
    assert_int_equal(take_picture("vehicle", "1"), 0);
    assert_int_equal(take_picture("vehicle", "2"), -1);
    assert_string_equal(error.text, "vehicle is there twice");
    assert_int_equal(picture.key.vehicle, 1);
}

static size_t below(uint64_t *next, size_t count)
{
    return (size_t)(random_mix((*next)++) % count);
}

/* A random query is refused with printable text, or its values are within bounds. */
static void test_noise(void **state)
{
    static const char *const keys[] = {"view", "vehicle", "size",   "after", "bar",
                                       "x",    "z",       "metres", "",      "siz"};
    static const char letters[] = "0123456789x.-+eE \t%<>\x01\x7f\xff";
    uint64_t next = fixture_seed(1);
    (void)state;
    for (int i = 0; i < TRIES; i++) {
        char value[40];
        size_t length = below(&next, sizeof value);
        for (size_t j = 0; j < length; j++)
            value[j] = letters[below(&next, sizeof letters - 1)];
        value[length] = '\0';
        const char *key = keys[below(&next, sizeof keys / sizeof keys[0])];
        query_picture_begin(&picture);
        query_map_begin(&map, WORLD_SIDE_DEFAULT_M);
        if (take_picture(key, value) != 0 && query_map_take(&map, key, value, &error) != 0)
            for (const char *at = error.text; *at != '\0'; at++)
                assert_true(*at >= ' ' && *at <= '~');
        assert_in_range(picture.key.width, QUERY_SIDE_MIN, QUERY_WIDTH_MAX);
        assert_in_range(picture.key.height, QUERY_SIDE_MIN, QUERY_HEIGHT_MAX);
        assert_in_range(map.width, QUERY_SIDE_MIN, QUERY_WIDTH_MAX);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_does_not_come_is_as_usual),
        cmocka_unit_test(test_a_whole_query),
        cmocka_unit_test(test_what_is_wrong_is_said),
        cmocka_unit_test(test_nothing_comes_twice),
        cmocka_unit_test(test_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
