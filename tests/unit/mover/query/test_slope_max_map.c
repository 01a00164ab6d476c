/* Squares whose ground is in nobody's way: where that is said there is no water on the way and no
 * slope too steep, whatever was asked before. */
#include "mover/query/slope_max_map.h"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SIDE    801
#define WAYS    100000
#define SAMPLES 32

static float posts[SIDE * SIDE];
static uint8_t cover[SIDE * SIDE];
static const struct terrain ground = {
    .posts = posts, .cover = cover, .side = SIDE, .spacing_m = WORLD_SIDE_M / (SIDE - 1)};
static struct slope_max_map easy;
static struct ground_marks scars;

/* From level in the west to rough in the east, with a pond here and there. */
static void raise(uint64_t *random)
{
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        posts[i] = (float)(fixture_uniform(random, 0.0, 60.0) * (i % SIDE) / SIDE);
        cover[i] = fixture_random(random) % 200 ? COVER_GRASS : COVER_LAKE;
    }
}

static void check_way(double x0, double z0, double x1, double z1, double slope)
{
    double length = sqrt((x1 - x0) * (x1 - x0) + (z1 - z0) * (z1 - z0));
    double before = terrain_height(&ground, NULL, x0, z0);
    for (int n = 1; n <= SAMPLES; n++) {
        double x = x0 + (x1 - x0) * n / SAMPLES, z = z0 + (z1 - z0) * n / SAMPLES;
        double y = terrain_height(&ground, NULL, x, z);
        assert_false(cover_is_water(terrain_cover(&ground, x, z)));
        assert_true(fabs(y - before) * SAMPLES < (slope - SLOPE_MAX_MAP_STEP / 2.0) * length);
        before = y;
    }
}

static void test_what_is_called_easy_is(void **state)
{
    uint64_t random = fixture_seed(77);
    uint32_t found = 0;
    (void)state;
    raise(&random);
    assert_int_equal(slope_max_map_init(&easy, &ground), 0);
    for (uint32_t i = 0; i < WAYS; i++) {
        double x0 = fixture_uniform(&random, 0.0, WORLD_SIDE_M), x1 = x0;
        double z0 = fixture_uniform(&random, 0.0, WORLD_SIDE_M), z1 = z0;
        double slope = fixture_uniform(&random, 0.05, 1.2);
        x1 = maths_clamp(x1 + fixture_uniform(&random, -150.0, 150.0), 0.0, WORLD_SIDE_M);
        z1 = maths_clamp(z1 + fixture_uniform(&random, -150.0, 150.0), 0.0, WORLD_SIDE_M);
        bool said = slope_max_map_between(&easy, &scars, x0, z0, x1, z1, slope);
        assert_true(slope_max_map_between(&easy, &scars, x1, z1, x0, z0, slope) == said);
        if (said)
            check_way(x0, z0, x1, z1, slope);
        found += said;
    }
    print_message("%u of %u ways are easy\n", found, WAYS);
    assert_true(found > WAYS / 20 && found < WAYS * 3 / 4);
    slope_max_map_free(&easy);
}

static void test_water_slopes_and_craters_are_not_easy(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        posts[i] = 0.0f;
        cover[i] = COVER_GRASS;
    }
    cover[80 * SIDE + 81] = COVER_SEA;
    posts[160 * SIDE + 161] = 10.0f;
    assert_int_equal(slope_max_map_init(&easy, &ground), 0);
    scars.square[gridsquare_of(20000.0, 20000.0) * GROUND_MARKS_BITS / 64] |=
        (uint64_t)GROUND_MARKS_CRATER << gridsquare_of(20000.0, 20000.0) * GROUND_MARKS_BITS % 64;
    assert_true(slope_max_map_between(&easy, &scars, 30000.0, 30000.0, 30100.0, 30100.0, 0.1));
    assert_false(slope_max_map_between(&easy, &scars, 5050.0, 5010.0, 5020.0, 5010.0, 1.0));
    assert_false(slope_max_map_between(&easy, &scars, 10010.0, 10010.0, 10090.0, 10010.0, 0.15));
    assert_true(slope_max_map_between(&easy, &scars, 10010.0, 10010.0, 10090.0, 10010.0, 0.3));
    assert_false(slope_max_map_between(&easy, &scars, 20010.0, 20010.0, 20020.0, 20010.0, 1.0));
    assert_false(slope_max_map_between(&easy, &scars, 30000.0, 30000.0, 31300.0, 30000.0, 1.0));
    slope_max_map_free(&easy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_called_easy_is),
        cmocka_unit_test(test_water_slopes_and_craters_are_not_easy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
