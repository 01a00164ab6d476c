/* Bounds of gridsquares. A path that is said to be above the ground never meets it; a way that is
 * said to be dry and less steep than a slope is so. The answers do not depend on what was asked
 * before. */
#include "world/terrain/square_bounds.h"

#include "collider/geometry/analytic_impact.h"
#include "tests/support/fixture.h"
#include "tests/support/works.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define SIDE       401 /* squares are cells */
#define CRATERS    2000
#define WAYS       100000
#define ROUGH_SIDE 801
#define SAMPLES    32

static struct terrain ground;
static struct square_bounds bounds;
static struct crater_index craters;
static struct crater dug[CRATERS];

/* Hills of 80 m from 1,500 m below the sea to 9,000 m above it. */
static void raise(uint64_t *random, double spacing_m)
{
    uint32_t side = (uint32_t)(WORLD_SIDE_DEFAULT_M / spacing_m) + 1;
    float *posts = malloc((size_t)side * side * sizeof *posts);
    assert_non_null(posts);
    for (uint32_t i = 0; i < side * side; i++)
        posts[i] = (float)(10500.0 * (i % side) / side - 1500.0 + fixture_uniform(random, 0, 80));
    ground = (struct terrain){
        .posts = posts, .side = side, .spacing_m = spacing_m, .squares = GRIDSQUARES_DEFAULT_INIT};
}

static void lower(void)
{
    free((void *)(uintptr_t)ground.posts);
    square_bounds_free(&bounds);
    crater_index_free(&craters);
}

static void open_ground(uint64_t *random, double spacing_m)
{
    raise(random, spacing_m);
    for (uint32_t i = 0; i < CRATERS; i++)
        dug[i] =
            (struct crater){fixture_uniform(random, 0.0, WORLD_SIDE_DEFAULT_M),
                            fixture_uniform(random, 0.0, WORLD_SIDE_DEFAULT_M), 40.0f, 60.0f, 1};
    assert_int_equal(crater_index_init(&craters, &GRIDSQUARES_DEFAULT, dug), 0);
    crater_index_update(&craters, CRATERS);
    assert_int_equal(
        square_bounds_init(&bounds, &GRIDSQUARES_DEFAULT, square_bounds_height, &ground), 0);
}

/* A path of up to 200 m near the ground, often from or to a crater's lip or a square's border. */
static struct path draw(uint64_t *random)
{
    const struct crater *crater = &dug[fixture_random(random) % CRATERS];
    struct vec3 at = {fixture_uniform(random, -100.0, WORLD_SIDE_DEFAULT_M + 100.0), 0.0,
                      fixture_uniform(random, 0.0, WORLD_SIDE_DEFAULT_M)};
    if (fixture_random(random) % 2)
        at = (struct vec3){crater->x + 40.0, 0.0, crater->z};
    if (fixture_random(random) % 4 == 0)
        at.x = GRIDSQUARE_LEAST_M *
               (double)(fixture_random(random) % (uint64_t)GRIDSQUARES_DEFAULT.per_side);
    at.y = terrain_height(&ground, &craters, at.x, at.z) + fixture_uniform(random, 0.0, 120.0);
    return (struct path){.at = at,
                         .along = {fixture_uniform(random, -140.0, 140.0),
                                   fixture_uniform(random, -60.0, 30.0),
                                   fixture_uniform(random, -140.0, 140.0)}};
}

static void check_ways(uint64_t *random)
{
    uint32_t above = 0, met = 0;
    for (uint32_t i = 0; i < WAYS; i++) {
        struct path path = draw(random);
        struct vec3 to = path_at(&path, 1.0);
        double toi;
        bool clear = square_bounds_clear(&bounds, &craters, path.at, to);
        bool meets = analytic_impact_ground(&ground, &craters, &path, &toi);
        assert_false(clear && meets);
        assert_true(square_bounds_clear(&bounds, &craters, path.at, to) == clear);
        above += clear;
        met += meets;
    }
    print_message("%u of %u paths are above the squares, %u meet the ground\n", above, WAYS, met);
    assert_true(above > WAYS / 20 && met > WAYS / 20);
}

static void test_a_path_above_its_squares_never_meets_the_ground(void **state)
{
    uint64_t random = fixture_seed(2026);
    static const double spacings[] = {125.0, 62.5};
    (void)state;
    for (uint32_t i = 0; i < sizeof spacings / sizeof spacings[0]; i++) {
        open_ground(&random, spacings[i]);
        check_ways(&random);
        lower();
    }
}

static void test_the_highest_post_of_the_square_counts_and_none_beyond_it(void **state)
{
    static float posts[SIDE * SIDE];
    const struct terrain flat = {
        .posts = posts, .side = SIDE, .spacing_m = 125.0, .squares = GRIDSQUARES_DEFAULT_INIT};
    struct vec3 at = {25.0 * 125.0 + 60.0, 11.0, 40.0 * 125.0 + 60.0};
    struct vec3 west = {at.x - 300.0, at.y, at.z}, beside = {at.x + 100.0, at.y, at.z};
    (void)state;
    posts[41 * SIDE + 26] = 50.0f; /* the square's south-eastern corner */
    assert_int_equal(square_bounds_init(&bounds, &GRIDSQUARES_DEFAULT, square_bounds_height, &flat),
                     0);
    assert_false(square_bounds_clear(&bounds, NULL, at, at));
    assert_false(square_bounds_clear(&bounds, NULL, west, beside));
    assert_true(square_bounds_clear(&bounds, NULL, west, west));
    at.y = west.y = 51.0;
    assert_true(square_bounds_clear(&bounds, NULL, at, west));
    square_bounds_free(&bounds);
}

/* The bound of a square with a work is above the work, and the square has no bound of its slope. */
static void test_works_raise_the_bounds(void **state)
{
    static float posts[SIDE * SIDE];
    static uint8_t grass[SIDE * SIDE];
    static struct earthwork works[60];
    struct terrain worked = {.posts = posts,
                             .cover = grass,
                             .side = SIDE,
                             .spacing_m = 125.0,
                             .squares = GRIDSQUARES_DEFAULT_INIT};
    uint64_t random = fixture_seed(15);
    int raised = 0;
    (void)state;
    works_scatter(works, 60, 24000.0, 26000.0, 1.0, &random);
    worked.earthworks = works_index(works, 60);
    for (int i = 0; i < 20000; i++) {
        double x = fixture_uniform(&random, 23900.0, 26100.0);
        double z = fixture_uniform(&random, 23900.0, 26100.0);
        double height = terrain_height(&worked, NULL, x, z);
        uint32_t square = gridsquare_of(&GRIDSQUARES_DEFAULT, x, z);
        assert_true(square_bounds_height(&worked, square) > square_bounds_below_height(height));
        if (height != 0.0)
            assert_int_equal(square_bounds_slope(&worked, square), SQUARE_BOUNDS_NONE);
        raised += height > 0.0;
    }
    assert_true(raised > 100);
    works_free(&worked.earthworks);
}

/* --- slopes ------------------------------------------------------------------------------------*/

static float rough[ROUGH_SIDE * ROUGH_SIDE];
static uint8_t cover[ROUGH_SIDE * ROUGH_SIDE];
static const struct terrain rough_ground = {.posts = rough,
                                            .cover = cover,
                                            .side = ROUGH_SIDE,
                                            .spacing_m = WORLD_SIDE_DEFAULT_M / (ROUGH_SIDE - 1),
                                            .squares = GRIDSQUARES_DEFAULT_INIT};

/* From level in the west to rough in the east, with a pond here and there. */
static void roughen(uint64_t *random)
{
    for (uint32_t i = 0; i < ROUGH_SIDE * ROUGH_SIDE; i++) {
        rough[i] = (float)(fixture_uniform(random, 0.0, 60.0) * (i % ROUGH_SIDE) / ROUGH_SIDE);
        cover[i] = fixture_random(random) % 200 ? COVER_GRASS : COVER_LAKE;
    }
}

static bool gentle(double x0, double z0, double x1, double z1, double slope)
{
    struct gridsquare_box box =
        gridsquare_box_of(&GRIDSQUARES_DEFAULT, maths_min(x0, x1), maths_min(z0, z1),
                          maths_max(x0, x1), maths_max(z0, z1));
    return square_bounds_within(&bounds, box, square_bounds_below_slope(slope));
}

static void check_way(double x0, double z0, double x1, double z1, double slope)
{
    double length = sqrt((x1 - x0) * (x1 - x0) + (z1 - z0) * (z1 - z0));
    double before = terrain_height(&rough_ground, NULL, x0, z0);
    for (int n = 1; n <= SAMPLES; n++) {
        double x = x0 + (x1 - x0) * n / SAMPLES, z = z0 + (z1 - z0) * n / SAMPLES;
        double y = terrain_height(&rough_ground, NULL, x, z);
        assert_false(cover_is_water(terrain_cover(&rough_ground, x, z)));
        assert_true(fabs(y - before) * SAMPLES < (slope - SQUARE_BOUNDS_SLOPE_STEP / 2.0) * length);
        before = y;
    }
}

static void test_what_is_called_gentle_is(void **state)
{
    uint64_t random = fixture_seed(77);
    uint32_t found = 0;
    (void)state;
    roughen(&random);
    assert_int_equal(
        square_bounds_init(&bounds, &GRIDSQUARES_DEFAULT, square_bounds_slope, &rough_ground), 0);
    for (uint32_t i = 0; i < WAYS; i++) {
        double x0 = fixture_uniform(&random, 0.0, WORLD_SIDE_DEFAULT_M), x1 = x0;
        double z0 = fixture_uniform(&random, 0.0, WORLD_SIDE_DEFAULT_M), z1 = z0;
        double slope = fixture_uniform(&random, 0.05, 1.2);
        x1 = maths_clamp(x1 + fixture_uniform(&random, -150.0, 150.0), 0.0, WORLD_SIDE_DEFAULT_M);
        z1 = maths_clamp(z1 + fixture_uniform(&random, -150.0, 150.0), 0.0, WORLD_SIDE_DEFAULT_M);
        bool said = gentle(x0, z0, x1, z1, slope);
        assert_true(gentle(x1, z1, x0, z0, slope) == said);
        if (said)
            check_way(x0, z0, x1, z1, slope);
        found += said;
    }
    print_message("%u of %u ways are gentle\n", found, WAYS);
    assert_true(found > WAYS / 20 && found < WAYS * 3 / 4);
    square_bounds_free(&bounds);
}

static void test_water_and_slopes_are_not_gentle(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < ROUGH_SIDE * ROUGH_SIDE; i++) {
        rough[i] = 0.0f;
        cover[i] = COVER_GRASS;
    }
    cover[80 * ROUGH_SIDE + 81] = COVER_SEA;
    rough[160 * ROUGH_SIDE + 161] = 10.0f;
    assert_int_equal(
        square_bounds_init(&bounds, &GRIDSQUARES_DEFAULT, square_bounds_slope, &rough_ground), 0);
    assert_true(gentle(30000.0, 30000.0, 30100.0, 30100.0, 0.1));
    assert_false(gentle(5050.0, 5010.0, 5020.0, 5010.0, 1.0));
    assert_false(gentle(10010.0, 10010.0, 10090.0, 10010.0, 0.15));
    assert_true(gentle(10010.0, 10010.0, 10090.0, 10010.0, 0.3));
    assert_false(gentle(30000.0, 30000.0, 31300.0, 30000.0, 1.0));
    square_bounds_free(&bounds);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_path_above_its_squares_never_meets_the_ground),
        cmocka_unit_test(test_the_highest_post_of_the_square_counts_and_none_beyond_it),
        cmocka_unit_test(test_works_raise_the_bounds),
        cmocka_unit_test(test_what_is_called_gentle_is),
        cmocka_unit_test(test_water_and_slopes_are_not_gentle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
