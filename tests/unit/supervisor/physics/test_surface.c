/* The physics check's own ground: known heights, and the project's ground at random points. */
#include "supervisor/physics/surface.h"

#include "tests/support/fixture.h"
#include "tests/support/works.h"
#include "world/terrain/crater.h"
#include "world/terrain/terrain.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define SIDE    401u
#define SPACING 125.0
#define CRATERS 60

static float posts[SIDE * SIDE];
static const struct terrain terrain = {
    .posts = posts, .side = SIDE, .spacing_m = SPACING, .squares = GRIDSQUARES_DEFAULT_INIT};
static struct crater craters[CRATERS];

static void set_post(uint32_t column, uint32_t row, float height)
{
    posts[row * SIDE + column] = height;
}

static void roughen(uint64_t *random)
{
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        posts[i] = (float)fixture_uniform(random, 0.0, 40.0);
    for (int i = 0; i < CRATERS; i++)
        craters[i] = (struct crater){
            fixture_uniform(random, 24900.0, 25100.0), fixture_uniform(random, 24900.0, 25100.0),
            (float)fixture_uniform(random, 0.5, 20.0), (float)fixture_uniform(random, 0.1, 8.0), 1};
}

static void test_a_cell_is_two_triangles(void **state)
{
    struct surface surface = {.terrain = &terrain};
    (void)state;
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        posts[i] = 10.0f;
    set_post(201, 200, 20.0f); /* the north-eastern post of cell (200, 200) */
    double west = 200 * SPACING, north = 200 * SPACING;
    /* The diagonal from north-west to south-east stays at 10 m. */
    assert_true(surface_height(&surface, west + 50.0, north + 50.0) == 10.0);
    assert_true(surface_height(&surface, west + 50.0, north + 60.0) == 10.0);
    assert_true(fabs(surface_height(&surface, west + 100.0, north + 25.0) - 16.0) < 1e-12);
    assert_true(fabs(surface_height(&surface, west + 125.0, north) - 20.0) < 1e-12);
}

static void test_a_crater_has_a_bowl_and_a_rim(void **state)
{
    struct surface surface = {.terrain = &terrain};
    const struct crater crater = {25000.0, 25000.0, 10.0f, 5.0f, 1};
    (void)state;
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        posts[i] = 100.0f;
    assert_int_equal(surface_update(&surface, &crater, 1), 0);
    assert_true(fabs(surface_height(&surface, 25000.0, 25000.0) - 95.0) < 1e-12);
    assert_true(fabs(surface_height(&surface, 25010.0, 25000.0) - 101.0) < 1e-12);
    assert_true(fabs(surface_height(&surface, 25000.0, 25012.5) - 100.25) < 1e-12);
    assert_true(surface_height(&surface, 25015.0, 25000.0) == 100.0);
    surface_free(&surface);
}

static void test_the_ground_is_that_of_the_world(void **state)
{
    uint64_t random = fixture_seed(11);
    struct surface surface = {.terrain = &terrain};
    struct crater_index index;
    (void)state;
    roughen(&random);
    assert_int_equal(crater_index_init(&index, &GRIDSQUARES_DEFAULT, craters), 0);
    for (uint32_t count = 0; count <= CRATERS; count += 20) {
        crater_index_update(&index, count);
        assert_int_equal(surface_update(&surface, craters, count), 0);
        for (int i = 0; i < 20000; i++) {
            double wide = i % 2 ? 150.0 : 25100.0;
            double x = 25000.0 + fixture_uniform(&random, -wide, wide);
            double z = 25000.0 + fixture_uniform(&random, -wide, wide);
            double height = surface_height(&surface, x, z);
            assert_true(fabs(height - terrain_height(&terrain, &index, x, z)) < 1e-10);
        }
    }
    crater_index_free(&index);
    surface_free(&surface);
}

/* A part that is one plane gives the heights; of any part no point is higher than its highest. */
static void test_parts_of_the_ground(void **state)
{
    uint64_t random = fixture_seed(13);
    struct surface surface = {.terrain = &terrain};
    int planes = 0;
    (void)state;
    roughen(&random);
    assert_int_equal(surface_update(&surface, craters, CRATERS), 0);
    for (int i = 0; i < 5000; i++) {
        double x = fixture_uniform(&random, 24700.0, 25300.0);
        double z = fixture_uniform(&random, 24700.0, 25300.0);
        double wide = fixture_uniform(&random, 0.5, 60.0);
        struct surface_part part = surface_around(&surface, x, z, wide);
        planes += part.flat;
        for (int j = 0; j < 20; j++) {
            double east = fixture_uniform(&random, -wide, wide);
            double south = fixture_uniform(&random, -wide, wide);
            if (east * east + south * south > wide * wide)
                continue;
            double height = surface_height(&surface, x + east, z + south);
            assert_true(height <= surface_part_most(&part, east, south) + 1e-9);
            double plane = part.at_m + east * part.east_m + south * part.south_m;
            assert_true(!part.flat || fabs(height - plane) < 1e-9);
        }
    }
    assert_true(planes > 200 && planes < 4800);
    surface_free(&surface);
}

/* The same lift as that of the mover, by other code. */
static void test_vehicles_stand_over_craters_as_the_mover_has_them(void **state)
{
    uint64_t random = fixture_seed(12);
    struct surface surface = {.terrain = &terrain};
    struct crater_index index;
    double highest = 0.0;
    (void)state;
    roughen(&random);
    assert_int_equal(crater_index_init(&index, &GRIDSQUARES_DEFAULT, craters), 0);
    crater_index_update(&index, CRATERS);
    assert_int_equal(surface_update(&surface, craters, CRATERS), 0);
    for (int i = 0; i < 4000; i++) {
        const struct crater *near = &craters[i % CRATERS];
        double sine, cosine, x = near->x + fixture_uniform(&random, -20.0, 20.0);
        double z = near->z + fixture_uniform(&random, -20.0, 20.0);
        maths_sincos(fixture_uniform(&random, 0.0, TWO_PI), &sine, &cosine);
        const struct crater_footing footing = {x, z, 3.5, 1.8, sine, cosine};
        const struct surface_rectangle under = {.middle = {x, 0.0, z},
                                                .forward = {3.5 * sine, 0.0, -3.5 * cosine},
                                                .right = {1.8 * cosine, 0.0, 1.8 * sine}};
        double lift = crater_lift(&index, &footing);
        assert_true(fabs(surface_clearance(&surface, &under) - lift) < 1e-9);
        highest = maths_max(highest, lift);
    }
    assert_true(highest > 0.5);
    crater_index_free(&index);
    surface_free(&surface);
}

/* The same heights, parts and lifts with earthworks, by other code. */
static void test_earthworks_are_those_of_the_world(void **state)
{
    static struct earthwork works[30];
    uint64_t random = fixture_seed(14);
    struct terrain worked = terrain;
    struct surface surface = {.terrain = &worked};
    (void)state;
    roughen(&random);
    works_scatter(works, 30, 24700.0, 25300.0, 0.6, &random);
    worked.earthworks = works_index(works, 30);
    for (int i = 0; i < 20000; i++) {
        double sine, cosine, x = fixture_uniform(&random, 24600.0, 25400.0);
        double z = fixture_uniform(&random, 24600.0, 25400.0);
        double height = terrain_height(&worked, NULL, x, z);
        struct surface_part part = surface_around(&surface, x, z, 5.0);
        double most = surface_part_most(&part, 3.0, -3.0);
        maths_sincos(fixture_uniform(&random, 0.0, TWO_PI), &sine, &cosine);
        const struct crater_footing footing = {x, z, 3.5, 1.8, sine, cosine};
        const struct surface_rectangle under = {.middle = {x, 0.0, z},
                                                .forward = {3.5 * sine, 0.0, -3.5 * cosine},
                                                .right = {1.8 * cosine, 0.0, 1.8 * sine}};
        assert_true(fabs(surface_height(&surface, x, z) - height) < 1e-9);
        assert_true(terrain_height(&worked, NULL, x + 3.0, z - 3.0) <= most + 1e-9);
        assert_true(fabs(surface_clearance(&surface, &under) -
                         terrain_lift(&worked, NULL, &footing)) < 1e-9);
    }
    works_free(&worked.earthworks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_cell_is_two_triangles),
        cmocka_unit_test(test_a_crater_has_a_bowl_and_a_rim),
        cmocka_unit_test(test_the_ground_is_that_of_the_world),
        cmocka_unit_test(test_parts_of_the_ground),
        cmocka_unit_test(test_earthworks_are_those_of_the_world),
        cmocka_unit_test(test_vehicles_stand_over_craters_as_the_mover_has_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
