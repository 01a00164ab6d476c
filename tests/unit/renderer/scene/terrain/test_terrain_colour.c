/* Ground textures: independent of the block size; water in low ground; roads and craters in their
 * places. */
#include "renderer/scene/terrain/terrain_colour.h"

#include "renderer/scene/noise/value_noise.h"
#include "renderer/scene/noise/value_noise_rows.h"
#include "renderer/scene/terrain/terrain_quadtree.h"
#include "renderer/scene/frame/light.h"
#include "tests/support/fixture.h"
#include "world/road_index.h"
#include "tests/support/works.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define POSTS    401u
#define SPACING  31.25
#define SEED     3u
#define SIDE_MAX 300u

/* A valley that rises to the east and west of x = 6000 m; the sea fills it up to 0 m. */
struct coast {
    struct world world;
    struct crater craters[2];
    struct crater_index index;
    struct road_index roads;
    struct road_point road[3];
    float posts[POSTS * POSTS];
    uint8_t cover[POSTS * POSTS];
    uint8_t rgba[SIDE_MAX * SIDE_MAX * 4], other[SIDE_MAX * SIDE_MAX * 4];
    float light[SIDE_MAX * SIDE_MAX];
};

static struct coast *coast;

static int open_coast(void **context)
{
    (void)context;
    coast = calloc(1, sizeof *coast);
    assert_non_null(coast);
    for (uint32_t row = 0; row < POSTS; row++)
        for (uint32_t column = 0; column < POSTS; column++) {
            double height = fabs(column * SPACING - 6000.0) / 10.0 - 150.0;
            uint32_t at = row * POSTS + column;
            coast->posts[at] = (float)maths_max(height, 0.0);
            coast->cover[at] = (uint8_t)(height <= 0.0                 ? COVER_SEA
                                         : (column / 9 + row / 11) % 2 ? COVER_GRASS
                                                                       : COVER_FOREST);
        }
    coast->road[0] = (struct road_point){.x = 9000.0f, .z = 2000.0f, .road = 7};
    coast->road[1] = (struct road_point){.x = 9500.0f, .z = 2500.0f, .road = 7};
    coast->road[2] = (struct road_point){.x = 9500.0f, .z = 9000.0f, .road = 8};
    coast->world.terrain = (struct terrain){.posts = coast->posts,
                                            .cover = coast->cover,
                                            .side = POSTS,
                                            .spacing_m = SPACING,
                                            .squares = GRIDSQUARES_DEFAULT_INIT};
    coast->world.road_points = coast->road;
    coast->world.counts.road_points = 3;
    if (road_index_make(&coast->roads, coast->road, 3, WORLD_SIDE_DEFAULT_M) != 0)
        return -1;
    return crater_index_init(&coast->index, &GRIDSQUARES_DEFAULT, coast->craters);
}

static int close_coast(void **context)
{
    (void)context;
    crater_index_free(&coast->index);
    road_index_free(&coast->roads);
    free(coast);
    return 0;
}

static bool make_texture(double x, double z, double step_m, uint32_t columns, uint32_t rows,
                         uint8_t *rgba)
{
    struct terrain_colour_tile tile = {.x = x,
                                       .z = z,
                                       .step_m = step_m,
                                       .columns = columns,
                                       .rows = rows,
                                       .sun = light_sun(),
                                       .relief = 1.0,
                                       .rgba = rgba,
                                       .light = coast->light,
                                       .roads = &coast->roads};
    return terrain_colour_ground(&coast->world, &coast->index, &tile);
}

static const uint8_t *texel(double x, double z)
{
    make_texture(x, z, 0.25, 1, 1, coast->rgba);
    return coast->rgba;
}

static double brightness(const uint8_t *rgb)
{
    return rgb[0] + rgb[1] + rgb[2];
}

/* A skid pan is grey, a ford is water, and the sunny side of a bank is brighter than the other. */
static void test_earthworks_have_their_colours(void **context)
{
    const struct vec3 sun = light_sun();
    struct earthwork works[3];
    (void)context;
    for (int i = 0; i < 3; i++)
        works[i] = (struct earthwork){.x = 9000.0 + 200.0 * i,
                                      .z = 7000.0,
                                      .sine = 0.0,
                                      .cosine = 1.0,
                                      .half_length = 30.0,
                                      .half_width = 30.0,
                                      .back_m = 10.0,
                                      .front_m = 10.0,
                                      .side_m = 10.0,
                                      .grip = 1.0};
    works[0].shape = EARTHWORK_SKID_PAN;
    works[1].shape = EARTHWORK_FORD;
    works[1].height_m = -1.0;
    works[2].shape = EARTHWORK_TABLE;
    works[2].height_m = 5.0;
    coast->world.terrain.earthworks = works_index(works, 3);
    const uint8_t *pan = texel(9011.0, 7012.0);
    assert_true(abs(pan[0] - pan[1]) < 25 && pan[2] >= pan[0]);
    assert_int_equal(texel(9200.0, 7000.0)[3], TERRAIN_COLOUR_WATER_ALPHA);
    double west = brightness(texel(9375.0, 7000.0)), east = brightness(texel(9425.0, 7000.0));
    assert_true(sun.x > 0.0 ? east > west + 20.0 : west > east + 20.0);
    works_free(&coast->world.terrain.earthworks);
}

static void test_rows_of_noise_equal_the_noise(void **context)
{
    (void)context;
    uint64_t state = fixture_seed(SEED);
    for (uint32_t i = 0; i < 200; i++) {
        struct value_noise_rows rows;
        double wavelength = fixture_uniform(&state, 3.0, 500.0);
        double step = wavelength / fixture_uniform(&state, 3.0, 90.0);
        double x = fixture_uniform(&state, -3e4, 9e4), z = fixture_uniform(&state, -3e4, 9e4);
        value_noise_rows_begin(&rows, wavelength, i, x, step, VALUE_NOISE_COLUMNS_MAX);
        for (uint32_t row = 0; row < 20; row++) {
            float values[VALUE_NOISE_COLUMNS_MAX] = {0.0f};
            value_noise_rows_add(&rows, z + row * step, 0.5f, values);
            for (uint32_t c = 0; c < VALUE_NOISE_COLUMNS_MAX; c++) {
                float one = value_noise_value((x + c * step) / wavelength,
                                              (z + row * step) / wavelength, i);
                assert_true(fabsf(values[c] - 0.5f * one) < 1e-5f);
            }
        }
    }
}

static void test_coarse_texels_have_no_fine_noise(void **context)
{
    (void)context;
    struct value_noise_rows rows;
    float values[VALUE_NOISE_COLUMNS_MAX] = {0.0f};
    value_noise_rows_begin(&rows, 10.0, 1, 0.0, 10.0, VALUE_NOISE_COLUMNS_MAX);
    value_noise_rows_add(&rows, 5.0, 1.0f, values);
    for (uint32_t c = 0; c < VALUE_NOISE_COLUMNS_MAX; c++)
        assert_true(values[c] == 0.0f);
}

/* A texture larger than a block equals smaller textures of the same place. */
static void test_blocks_do_not_show(void **context)
{
    (void)context;
    const uint32_t side = SIDE_MAX, cut = 77, part = 150;
    const double step = 4.0, x = 7200.0, z = 1900.0;
    make_texture(x, z, step, side, side, coast->rgba);
    make_texture(x + cut * step, z + cut * step, step, part, part, coast->other);
    for (uint32_t row = 0; row < part; row++)
        for (uint32_t i = 0; i < part * 4; i++)
            assert_true(abs(coast->other[row * part * 4 + i] -
                            coast->rgba[((row + cut) * side + cut) * 4 + i]) <= 1);
}

static void test_the_sea_ends_where_the_ground_rises(void **context)
{
    (void)context;
    uint64_t state = fixture_seed(SEED);
    uint32_t wet = 0;
    for (uint32_t i = 0; i < 3000; i++) {
        double x = fixture_uniform(&state, 7300.0, 7700.0);
        double z = fixture_uniform(&state, 1000.0, 9000.0);
        double height = terrain_base_height(&coast->world.terrain, x, z);
        bool water = texel(x, z)[3] <= TERRAIN_COLOUR_SHORE_ALPHA;
        wet += water;
        assert_true(!water || height < 1.0);
        assert_true(water || height > 0.0 || x > 7450.0);
    }
    assert_true(wet > 1000 && wet < 2500);
    assert_true(make_texture(7500.0, 5000.0, 1.0, 8, 8, coast->rgba));
    assert_false(make_texture(9500.0, 5000.0, 1.0, 8, 8, coast->rgba));
}

/* Towards its shore the sea's alpha rises and its colour becomes lighter. */
static void test_the_sea_is_shallow_at_its_shore(void **context)
{
    (void)context;
    uint8_t open[4];
    memcpy(open, texel(6000.0, 5000.0), sizeof open);
    assert_int_equal(open[3], TERRAIN_COLOUR_WATER_ALPHA);
    const uint8_t *shore = texel(7490.0, 5000.0);
    assert_true(shore[3] > 20 && shore[3] <= TERRAIN_COLOUR_SHORE_ALPHA);
    assert_true(brightness(shore) > brightness(open) + 60.0);
}

static void test_roads_show_at_every_size(void **context)
{
    (void)context;
    for (double step = 0.25; step < 70.0; step *= 2.0) {
        const uint32_t side = 65, middle = 32 * side + 32;
        make_texture(9250.0 - 32.0 * step, 2250.0 - 32.0 * step, step, side, side, coast->rgba);
        /* Compared with the mean of two places at the same distance on both sides. */
        double aside = 0.0;
        uint32_t steps = (uint32_t)(step < 1.0 ? 10.0 / step : 10.0);
        steps = steps > 30 ? 30 : steps;
        aside += brightness(coast->rgba + (size_t)(middle - steps + steps * side) * 4);
        aside += brightness(coast->rgba + (size_t)(middle + steps - steps * side) * 4);
        double off = fabs(brightness(coast->rgba + (size_t)middle * 4) - 0.5 * aside);
        if (step * steps > 8.0)
            assert_true(off > 8.0);
    }
    /* Not between the end of one road and the beginning of another. */
    make_texture(9499.0, 5000.0, 0.5, 8, 8, coast->rgba);
    struct road_point kept = coast->road[2];
    coast->road[2].x = 100.0f;
    make_texture(9499.0, 5000.0, 0.5, 8, 8, coast->other);
    coast->road[2] = kept;
    assert_memory_equal(coast->rgba, coast->other, sizeof(uint8_t) * 8 * 8 * 4);
}

static void test_craters_are_scorched_and_lit(void **context)
{
    (void)context;
    const uint32_t side = 64;
    const double step = 0.25, x = 9800.0, z = 7000.0;
    make_texture(x - 8.0, z - 8.0, step, side, side, coast->other);
    coast->craters[0] = (struct crater){.x = x, .z = z, .radius_m = 4.0f, .depth_m = 1.6f};
    crater_index_update(&coast->index, 1);
    make_texture(x - 8.0, z - 8.0, step, side, side, coast->rgba);
    double inside = 0.0, before = 0.0, to_sun = 0.0, from_sun = 0.0;
    for (uint32_t row = 0; row < side; row++)
        for (uint32_t column = 0; column < side; column++) {
            double dx = column * step - 8.0, dz = row * step - 8.0, off = hypot(dx, dz);
            const uint8_t *now = coast->rgba + (row * side + column) * 4;
            if (off > 4.0)
                continue;
            inside += brightness(now);
            before += brightness(coast->other + (row * side + column) * 4);
            /* The slope on the far side faces the sun. */
            if (off > 2.0 && dx * SUN_X + dz * SUN_Z < -0.7 * off)
                to_sun += brightness(now);
            if (off > 2.0 && dx * SUN_X + dz * SUN_Z > 0.7 * off)
                from_sun += brightness(now);
        }
    assert_true(inside < 0.7 * before);
    assert_true(to_sun > 1.1 * from_sun);
    crater_index_update(&coast->index, 0);
}

/* Past the edges the ground continues without a step. */
static void test_ground_continues_past_the_square(void **context)
{
    (void)context;
    const struct terrain *terrain = &coast->world.terrain;
    uint64_t state = fixture_seed(SEED);
    double last = (POSTS - 1) * SPACING;
    for (uint32_t i = 0; i < 2000; i++) {
        double x = fixture_uniform(&state, -20000.0, last + 20000.0);
        double z = fixture_uniform(&state, -20000.0, last + 20000.0);
        double in_x = x, in_z = z;
        terrain_quadtree_beyond(terrain, &in_x, &in_z);
        assert_true(in_x >= 0.0 && in_x <= last && in_z >= 0.0 && in_z <= last);
        if (x >= 0.0 && x <= last && z >= 0.0 && z <= last)
            assert_true(in_x == x && in_z == z);
        double near_x = x + 1.0, near_z = z;
        terrain_quadtree_beyond(terrain, &near_x, &near_z);
        assert_true(fabs(near_x - in_x) < 8.0 && fabs(near_z - in_z) < 8.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_earthworks_have_their_colours),
        cmocka_unit_test(test_rows_of_noise_equal_the_noise),
        cmocka_unit_test(test_coarse_texels_have_no_fine_noise),
        cmocka_unit_test(test_blocks_do_not_show),
        cmocka_unit_test(test_the_sea_ends_where_the_ground_rises),
        cmocka_unit_test(test_the_sea_is_shallow_at_its_shore),
        cmocka_unit_test(test_roads_show_at_every_size),
        cmocka_unit_test(test_craters_are_scorched_and_lit),
        cmocka_unit_test(test_ground_continues_past_the_square),
    };
    return cmocka_run_group_tests(tests, open_coast, close_coast);
}
