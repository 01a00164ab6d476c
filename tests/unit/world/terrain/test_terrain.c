/* The ground between its posts, outside them, and with craters in it. */
#include "world/terrain/terrain.h"

#include "tests/support/fixture.h"
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

static float posts[SIDE * SIDE];
static uint8_t cover[SIDE * SIDE];
static const struct terrain terrain = {.posts = posts,
                                       .cover = cover,
                                       .side = SIDE,
                                       .spacing_m = SPACING,
                                       .squares = GRIDSQUARES_DEFAULT_INIT};

static float *post(uint32_t column, uint32_t row)
{
    return &posts[row * SIDE + column];
}

static void level(float height_m)
{
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        posts[i] = height_m;
        cover[i] = COVER_GRASS;
    }
}

static double height(double x, double z)
{
    return terrain_base_height(&terrain, x, z);
}

static void test_height_at_every_post_is_the_posts(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    fixture_roughen(posts, cover, SIDE * SIDE, &random);
    for (uint32_t row = 0; row < SIDE; row++) {
        for (uint32_t column = 0; column < SIDE; column++)
            assert_true(height(column * SPACING, row * SPACING) == (double)*post(column, row));
    }
}

/* Height of the plane through three posts, solved from two edge vectors: not the code's way. */
static double plane(double ax, double az, double ah, double bx, double bz, double bh, double cx,
                    double cz, double ch, double x, double z)
{
    double area = (bx - ax) * (cz - az) - (cx - ax) * (bz - az);
    double b = ((x - ax) * (cz - az) - (cx - ax) * (z - az)) / area;
    double c = ((bx - ax) * (z - az) - (x - ax) * (bz - az)) / area;
    return ah + b * (bh - ah) + c * (ch - ah);
}

static void test_two_flat_triangles_a_cell_split_from_north_west_to_south_east(void **state)
{
    uint64_t random = fixture_seed(2);
    (void)state;
    fixture_roughen(posts, cover, SIDE * SIDE, &random);
    for (int i = 0; i < 100000; i++) {
        double x = fixture_uniform(&random, 0.0, WORLD_SIDE_DEFAULT_M);
        double z = fixture_uniform(&random, 0.0, WORLD_SIDE_DEFAULT_M);
        uint32_t column = (uint32_t)(x / SPACING), row = (uint32_t)(z / SPACING);
        double x0 = column * SPACING, z0 = row * SPACING, x1 = x0 + SPACING, z1 = z0 + SPACING;
        double nw = (double)*post(column, row), se = (double)*post(column + 1, row + 1);
        double right =
            x - x0 >= z - z0
                ? plane(x0, z0, nw, x1, z0, (double)*post(column + 1, row), x1, z1, se, x, z)
                : plane(x0, z0, nw, x0, z1, (double)*post(column, row + 1), x1, z1, se, x, z);
        assert_true(fabs(height(x, z) - right) < 1e-8);
    }
}

static void test_continuous_across_edges_and_diagonals(void **state)
{
    const double step = 1e-6;
    const double steepest = 2 * 1550.0 / SPACING; /* rise a metre that the posts allow */
    uint64_t random = fixture_seed(3);
    (void)state;
    fixture_roughen(posts, cover, SIDE * SIDE, &random);
    for (int i = 0; i < 100000; i++) {
        double border = SPACING * (double)(1 + fixture_random(&random) % (SIDE - 2));
        double along = fixture_uniform(&random, 0.0, WORLD_SIDE_DEFAULT_M);
        assert_true(fabs(height(border - step, along) - height(border, along)) < step * steepest);
        assert_true(fabs(height(along, border - step) - height(along, border)) < step * steepest);
        double x = fixture_uniform(&random, 0.0, SPACING), z = x; /* on a diagonal */
        x += border - SPACING, z += border - SPACING;
        assert_true(fabs(height(x + step, z) - height(x, z + step)) < 2 * step * steepest);
    }
}

static void test_outside_the_edges_height_goes_on(void **state)
{
    uint64_t random = fixture_seed(4);
    (void)state;
    fixture_roughen(posts, cover, SIDE * SIDE, &random);
    for (int i = 0; i < 10000; i++) {
        double along = fixture_uniform(&random, 0.0, WORLD_SIDE_DEFAULT_M);
        double beyond = fixture_uniform(&random, 0.0, 1e6);
        assert_true(height(-beyond, along) == height(0.0, along));
        assert_true(height(WORLD_SIDE_DEFAULT_M + beyond, along) ==
                    height(WORLD_SIDE_DEFAULT_M, along));
        assert_true(height(along, -beyond) == height(along, 0.0));
        assert_true(height(along, WORLD_SIDE_DEFAULT_M + beyond) ==
                    height(along, WORLD_SIDE_DEFAULT_M));
    }
    assert_true(height(-1e300, 1e300) == (double)*post(0, SIDE - 1));
    assert_true(height(INFINITY, INFINITY) == (double)*post(SIDE - 1, SIDE - 1));
    assert_true(isfinite(height(NAN, NAN)));
}

static void test_normal_of_level_and_tilted_ground(void **state)
{
    (void)state;
    level(300.0f);
    struct vec3 n = terrain_normal(&terrain, NULL, 25000.0, 25000.0);
    assert_true(n.x == 0.0 && n.y == 1.0 && n.z == 0.0);
    for (uint32_t row = 0; row < SIDE; row++) {
        for (uint32_t column = 0; column < SIDE; column++)
            *post(column, row) = 50.0f * (float)column + 25.0f * (float)row;
    }
    double rise_east = 50.0 / SPACING, rise_south = 25.0 / SPACING;
    double length = sqrt(rise_east * rise_east + 1.0 + rise_south * rise_south);
    n = terrain_normal(&terrain, NULL, 25010.0, 24980.0);
    assert_true(fabs(n.x + rise_east / length) < 1e-9);
    assert_true(fabs(n.y - 1.0 / length) < 1e-9);
    assert_true(fabs(n.z + rise_south / length) < 1e-9);
}

static void test_normal_is_a_unit_vector_upwards_everywhere(void **state)
{
    uint64_t random = fixture_seed(5);
    (void)state;
    fixture_roughen(posts, cover, SIDE * SIDE, &random);
    for (int i = 0; i < 20000; i++) {
        struct vec3 n = terrain_normal(&terrain, NULL, fixture_uniform(&random, -100.0, 50100.0),
                                       fixture_uniform(&random, -100.0, 50100.0));
        assert_true(fabs(vec3_length(n) - 1.0) < 1e-12);
        assert_true(n.y > 0.0);
    }
}

static void test_cover_is_the_nearest_posts(void **state)
{
    uint64_t random = fixture_seed(6);
    (void)state;
    fixture_roughen(posts, cover, SIDE * SIDE, &random);
    for (int i = 0; i < 100000; i++) {
        double x = fixture_uniform(&random, -200.0, 50200.0);
        double z = fixture_uniform(&random, -200.0, 50200.0);
        double column = fmin(fmax(floor(x / SPACING + 0.5), 0.0), SIDE - 1.0);
        double row = fmin(fmax(floor(z / SPACING + 0.5), 0.0), SIDE - 1.0);
        assert_int_equal(terrain_cover(&terrain, x, z),
                         cover[(uint32_t)row * SIDE + (uint32_t)column]);
    }
}

static void test_only_sea_and_lake_are_water(void **state)
{
    (void)state;
    for (int i = 0; i < COVER_COUNT; i++)
        assert_int_equal(cover_is_water((enum cover)i), i == COVER_SEA || i == COVER_LAKE);
}

static void test_craters_change_height_and_normal(void **state)
{
    const struct crater dug = {1000.0, 1000.0, 10.0f, 4.0f, 7};
    struct crater_index craters;
    (void)state;
    level(100.0f);
    assert_int_equal(crater_index_init(&craters, &GRIDSQUARES_DEFAULT, &dug), 0);
    crater_index_update(&craters, 1);
    assert_true(terrain_height(&terrain, &craters, 1000.0, 1000.0) == 96.0);
    assert_true(terrain_height(&terrain, NULL, 1000.0, 1000.0) == 100.0);
    assert_true(terrain_base_height(&terrain, 1000.0, 1000.0) == 100.0);
    struct vec3 west_wall = terrain_normal(&terrain, &craters, 993.0, 1000.0);
    assert_true(west_wall.x > 0.1); /* leans to the middle */
    assert_true(terrain_normal(&terrain, &craters, 1020.0, 1000.0).y == 1.0);
    crater_index_free(&craters);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_height_at_every_post_is_the_posts),
        cmocka_unit_test(test_two_flat_triangles_a_cell_split_from_north_west_to_south_east),
        cmocka_unit_test(test_continuous_across_edges_and_diagonals),
        cmocka_unit_test(test_outside_the_edges_height_goes_on),
        cmocka_unit_test(test_normal_of_level_and_tilted_ground),
        cmocka_unit_test(test_normal_is_a_unit_vector_upwards_everywhere),
        cmocka_unit_test(test_cover_is_the_nearest_posts),
        cmocka_unit_test(test_only_sea_and_lake_are_water),
        cmocka_unit_test(test_craters_change_height_and_normal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
