/* The shapes of earthworks at places known by hand, their continuity, the index against a search
 * through all works, and vehicles on them on one, two and four threads. SEED=n tries others. */
#include "world/terrain/earthwork.h"

#include "tests/support/fixture.h"
#include "tests/support/works.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/terrain.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define NEAR(a, b) assert_true(fabs((a) - (b)) < 1e-9)

/* Each work is alone in its place. The ground is at 100 m. */
static const char course[] =
    "earthworks = ("
    "{ shape = \"ramp\"; at = [1000.0, 1000.0]; length_m = 12.0; width_m = 8.0; height_m = 2.0;"
    "  edge_m = 1.0; },"
    "{ shape = \"table\"; at = [2000.0, 1000.0]; heading_deg = 90.0; length_m = 60.0;"
    "  width_m = 20.0; height_m = 6.0; edge_m = 3.0; grade_percent = 30.0; },"
    "{ shape = \"trench\"; at = [3000.0, 1000.0]; length_m = 3.0; width_m = 10.0; depth_m = 1.5;"
    "  edge_m = 0.5; },"
    "{ shape = \"washboard\"; at = [4000.0, 1000.0]; length_m = 20.0; width_m = 8.0;"
    "  height_m = 0.2; wave_m = 2.0; },"
    "{ shape = \"ford\"; at = [5000.0, 1000.0]; length_m = 40.0; width_m = 20.0; depth_m = 0.75; },"
    "{ shape = \"skid_pan\"; at = [6000.0, 1000.0]; length_m = 40.0; width_m = 20.0; grip = 0.2; },"
    "{ shape = \"trench\"; at = [2000.0, 1000.0]; length_m = 4.0; width_m = 60.0; depth_m = 1.0;"
    "  edge_m = 0.25; } );";

static struct fixture f;

static int open_course(void **state)
{
    (void)state;
    fixture_open(&f, course);
    return 0;
}

static double height(double x, double z)
{
    return terrain_height(&f.view.world.terrain, NULL, x, z) - FIXTURE_GROUND_M;
}

static void test_ramp(void **state)
{
    (void)state;
    NEAR(height(1000.0, 1006.0), 0.0); /* it rises to the north, over 11 m */
    NEAR(height(1000.0, 1000.5), 1.0);
    NEAR(height(1000.0, 995.0), 2.0);
    NEAR(height(1000.0, 994.5), 1.0);
    NEAR(height(1000.0, 994.0), 0.0);
    NEAR(height(1003.5, 995.0), 1.0);
    NEAR(height(996.0, 995.0), 0.0);
    struct vec3 normal = terrain_normal(&f.view.world.terrain, NULL, 1000.0, 1000.0);
    NEAR(normal.z / normal.y, 2.0 / 11.0);
    NEAR(normal.x, 0.0);
}

static void test_table_and_the_trench_in_it(void **state)
{
    (void)state;
    NEAR(height(1970.0, 1006.5), 0.0); /* its length is from west to east */
    NEAR(height(1980.0, 1006.5), 3.0);
    NEAR(height(1995.0, 1006.5), 6.0);
    NEAR(height(2020.0, 1006.5), 3.0);
    NEAR(height(2000.0, 1008.5), 3.0);
    NEAR(height(2000.0, 1000.0), 5.0); /* 6 m up and 1 m down again */
}

static void test_trench(void **state)
{
    (void)state;
    NEAR(height(3000.0, 1000.0), -1.5);
    NEAR(height(3000.0, 998.75), -0.75);
    NEAR(height(3004.75, 1000.0), -0.75);
    NEAR(height(3000.0, 998.4), 0.0);
}

static void test_washboard(void **state)
{
    (void)state;
    for (double z = 1008.0; z > 992.0; z -= 2.0) {
        NEAR(height(4000.0, z), 0.0);
        NEAR(height(4000.0, z - 1.0), 0.2);
        NEAR(height(4000.0, z - 0.5), 0.1);
    }
}

static void test_ford_and_its_water(void **state)
{
    const struct terrain *terrain = &f.view.world.terrain;
    (void)state;
    NEAR(height(5000.0, 1000.0), -1.0);
    NEAR(terrain_water_depth(terrain, 5000.0, 1000.0), 0.75);
    NEAR(height(5000.0, 985.0), -0.5); /* its ends have a grade of 10 % */
    NEAR(terrain_water_depth(terrain, 5000.0, 985.0), 0.25);
    NEAR(terrain_water_depth(terrain, 5000.0, 982.0), 0.0);
    NEAR(terrain_water_depth(terrain, 3000.0, 1000.0), 0.0); /* a trench is dry */
}

static void test_skid_pan(void **state)
{
    const struct earthworks *works = &f.view.world.terrain.earthworks;
    (void)state;
    NEAR(earthwork_grip(works, 6000.0, 1000.0), 0.2);
    NEAR(earthwork_grip(works, 6000.0, 1021.0), 1.0);
    NEAR(earthwork_grip(works, 1000.0, 1000.0), 1.0);
    NEAR(height(6000.0, 1000.0), 0.0);
}

/* A jeep of 3.4 m in the 3 m trench and on the ramp's lip: no corner is under the ground. */
static void test_vehicles_are_lifted_over_works(void **state)
{
    const struct crater_footing in = {3000.0, 1000.0, 1.7, 0.8, 0.0, 1.0};
    const struct crater_footing on = {1000.0, 994.0, 1.7, 0.8, 0.0, 1.0};
    (void)state;
    NEAR(terrain_lift(&f.view.world.terrain, NULL, &in), 1.5);
    assert_true(terrain_lift(&f.view.world.terrain, NULL, &on) > 0.5);
}

static void test_a_world_without_works_has_none(void **state)
{
    const struct earthworks none = {.works = NULL};
    const struct gridsquare_box box = {0, 0, 399, 399};
    double highest, lowest;
    (void)state;
    assert_true(earthwork_offset(&none, 5.0, 5.0) == 0.0);
    assert_true(earthwork_grip(&none, 5.0, 5.0) == 1.0);
    assert_true(earthwork_water(&none, 5.0, 5.0) == 0.0);
    assert_false(earthwork_range(&none, &box, &highest, &lowest));
}

/* --- many works --------------------------------------------------------------------------------*/

#define WORKS 200

static struct earthwork works[WORKS];

static double by_search(double x, double z)
{
    double highest = 0.0, deepest = 0.0;
    for (int i = WORKS - 1; i >= 0; i--) {
        highest = maths_max(highest, earthwork_height(&works[i], x, z));
        deepest = maths_min(deepest, earthwork_height(&works[i], x, z));
    }
    return highest + deepest;
}

static void test_index_finds_every_work(void **state)
{
    uint64_t random = fixture_seed(41);
    int changed = 0;
    (void)state;
    works_scatter(works, WORKS, 24000.0, 26000.0, 0.4, &random);
    struct earthworks all = works_index(works, WORKS);
    for (int i = 0; i < 100000; i++) {
        double x = fixture_uniform(&random, 23700.0, 26300.0);
        double z = fixture_uniform(&random, 23700.0, 26300.0);
        double offset = earthwork_offset(&all, x, z), highest, lowest;
        const struct gridsquare_box box = gridsquare_box_of(&GRIDSQUARES_DEFAULT, x, z, x, z);
        earthwork_range(&all, &box, &highest, &lowest);
        assert_true(offset == by_search(x, z));
        assert_true(offset <= highest && offset >= lowest);
        changed += offset != 0.0;
    }
    assert_true(changed > 3000 && changed < 60000);
    works_free(&all);
}

/* Between two near points the height changes by no more than the steepest slopes of a rise and of a
 * dig together. */
/* Where a work changes the ground, it is near every point from which that is in reach. */
static void test_works_in_reach_are_near(void **state)
{
    uint64_t random = fixture_seed(42);
    int far = 0;
    (void)state;
    works_scatter(works, WORKS, 24000.0, 26000.0, 0.4, &random);
    struct earthworks all = works_index(works, WORKS);
    for (int i = 0; i < 20000; i++) {
        double x = fixture_uniform(&random, 23700.0, 26300.0), reach = 8.0;
        double z = fixture_uniform(&random, 23700.0, 26300.0);
        double sine, cosine, way = fixture_uniform(&random, 0.0, reach);
        maths_sincos(fixture_uniform(&random, -3.0, 3.0), &sine, &cosine);
        bool changed = earthwork_offset(&all, x + way * sine, z + way * cosine) != 0.0;
        bool near = earthwork_near(&all, x, z, reach);
        assert_true(near || !changed);
        far += !near;
    }
    assert_true(far > 5000);
    works_free(&all);
}

static void test_the_ground_is_continuous(void **state)
{
    uint64_t random = fixture_seed(42);
    (void)state;
    works_scatter(works, WORKS, 24000.0, 26000.0, 0.4, &random);
    struct earthworks all = works_index(works, WORKS);
    const double apart = 1e-4, steepest = 3.0 / 0.4 + 3.0 * PI / 2.0;
    for (int i = 0; i < 100000; i++) {
        double x = fixture_uniform(&random, 24000.0, 26000.0);
        double z = fixture_uniform(&random, 24000.0, 26000.0);
        if (i % 2) /* at a border of gridsquares */
            x = GRIDSQUARE_LEAST_M * floor(x / GRIDSQUARE_LEAST_M);
        double rise = earthwork_offset(&all, x, z) - earthwork_offset(&all, x - apart, z - apart);
        assert_true(fabs(rise) <= 2.0 * 1.5 * steepest * apart);
    }
    works_free(&all);
}

/* --- vehicles on them --------------------------------------------------------------------------*/

/* The digest after 600 frames in which vehicles drive over every work. */
static uint64_t drive_over(uint32_t threads)
{
    static const char *const kinds[] = {"jeep", "tank", "truck"};
    uint64_t digest;
    fixture_open(&f, course);
    fixture_threads(&f, threads);
    for (int i = 0; i < 24; i++) {
        double aside = 2.5 * (i / 6 - 1.5);
        fixture_put(&f, (struct fixture_entity){
                            .kind = kinds[i % 3],
                            .at = {1000.0 * (1 + i % 6) + aside, FIXTURE_GROUND_M, 1050.0},
                            .velocity = {0.0, 0.0, -8.0}});
    }
    fixture_run(&f, 600);
    digest = fixture_digest(&f);
    fixture_close(&f);
    return digest;
}

static void test_threads_agree(void **state)
{
    uint64_t one = drive_over(1);
    (void)state;
    assert_true(drive_over(2) == one);
    assert_true(drive_over(4) == one);
}

/* A jeep that drives over the ramp is on it halfway, and nose up. */
static void test_a_vehicle_drives_up_the_ramp(void **state)
{
    (void)state;
    uint32_t jeep =
        fixture_put(&f, (struct fixture_entity){.kind = "jeep",
                                                .at = {1000.0, FIXTURE_GROUND_M, 1008.0},
                                                .velocity = {0.0, 0.0, -8.0}});
    double highest = 0.0, steepest = 0.0;
    for (int i = 0; i < 120; i++) {
        fixture_run(&f, 1);
        struct state now = fixture_state(&f);
        highest = maths_max(highest, now.entities.row[jeep].y - FIXTURE_GROUND_M);
        steepest = maths_max(steepest, now.entities.row[jeep].pitch);
    }
    assert_true(highest > 1.5 && steepest > 0.1);
}

#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_course, fixture_teardown, &f)

/* The slopes of a ramp fill its length, whatever their sum is rounded to: 3.35 m with an edge of
 * 0.365 m was too short by a bit. */
static void test_ramps_of_any_length_are_right(void **state)
{
    char text[32768];
    size_t used = (size_t)snprintf(text, sizeof text, "earthworks = (");
    (void)state;
    for (int i = 0; i < 200; i++)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "%s { shape = \"ramp\"; at = [%d.0, 1000.0]; length_m = %.2f; "
                                 "width_m = 4.0; height_m = 0.5; edge_m = 0.365; }",
                                 i > 0 ? "," : "", 1000 + 20 * i, 3.0 + 0.05 * i);
    snprintf(text + used, sizeof text - used, ");");
    fixture_open(&f, text);
    assert_int_equal(f.view.world.terrain.earthworks.count, 200);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_ramp),
        TEST(test_table_and_the_trench_in_it),
        TEST(test_trench),
        TEST(test_washboard),
        TEST(test_ford_and_its_water),
        TEST(test_skid_pan),
        TEST(test_vehicles_are_lifted_over_works),
        cmocka_unit_test(test_ramps_of_any_length_are_right),
        cmocka_unit_test(test_a_world_without_works_has_none),
        cmocka_unit_test(test_index_finds_every_work),
        cmocka_unit_test(test_works_in_reach_are_near),
        cmocka_unit_test(test_the_ground_is_continuous),
        cmocka_unit_test(test_threads_agree),
        TEST(test_a_vehicle_drives_up_the_ramp),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
