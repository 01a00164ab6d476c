/* Craters: their shape, their overlap in any order, and the index over them (row 31). */
#include "world/terrain/crater.h"

#include "tests/support/fixture.h"
#include "world/terrain/gridsquare.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define MANY 400

static void index_of(struct crater_index *index, const struct crater *craters, uint32_t count)
{
    assert_int_equal(crater_index_init(index, &GRIDSQUARES_DEFAULT, craters), 0);
    crater_index_update(index, count);
    assert_int_equal(index->count, count);
}

static struct crater random_crater(uint64_t *random)
{
    return (struct crater){
        fixture_uniform(random, 24900.0, 25100.0), fixture_uniform(random, 24900.0, 25100.0),
        (float)fixture_uniform(random, 0.5, 40.0), (float)fixture_uniform(random, 0.1, 10.0), 1};
}

/* The same profile over the whole list, straight from its description. */
static double oracle_offset(const struct crater *craters, uint32_t count, double x, double z)
{
    double deepest = 0.0, highest = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        double radius = (double)craters[i].radius_m, depth = (double)craters[i].depth_m;
        double r = hypot(x - craters[i].x, z - craters[i].z) / radius;
        double rim = 0.2 * depth;
        double outwards = (1.5 - r) / 0.5;
        double offset = r < 1.0   ? -depth + (depth + rim) * r * r
                        : r < 1.5 ? rim * outwards * outwards
                                  : 0.0;
        deepest = fmin(deepest, offset);
        highest = fmax(highest, offset);
    }
    return deepest < 0.0 ? deepest : highest;
}

static void test_bowl_rim_and_untouched_ground(void **state)
{
    const struct crater crater = {1000.0, 2000.0, 10.0f, 4.0f, 1};
    struct crater_index index;
    (void)state;
    index_of(&index, &crater, 1);
    assert_true(crater_offset(&index, 1000.0, 2000.0) == -4.0);
    assert_true(fabs(crater_offset(&index, 1010.0, 2000.0) - 0.8) <
                1e-12); /* a fifth, at the lip */
    assert_true(crater_offset(&index, 1000.0, 2012.0) > 0.0);
    assert_true(crater_offset(&index, 1015.0, 2000.0) == 0.0);
    assert_true(crater_offset(&index, 1000.0, 1985.0) == 0.0);
    assert_true(crater_offset(&index, 1500.0, 2000.0) == 0.0);
    crater_index_free(&index);
}

static void test_ground_is_continuous_across_the_crater(void **state)
{
    const struct crater crater = {1000.0, 2000.0, 10.0f, 4.0f, 1};
    struct crater_index index;
    (void)state;
    index_of(&index, &crater, 1);
    for (double x = 980.0; x < 1020.0; x += 0.001)
        assert_true(fabs(crater_offset(&index, x, 2000.0) -
                         crater_offset(&index, x + 0.001, 2000.0)) < 0.001);
    crater_index_free(&index);
}

static void test_no_craters_no_change(void **state)
{
    struct crater_index index;
    (void)state;
    index_of(&index, NULL, 0);
    assert_true(crater_offset(&index, 0.0, 0.0) == 0.0);
    assert_true(crater_offset(&index, WORLD_SIDE_DEFAULT_M, WORLD_SIDE_DEFAULT_M) == 0.0);
    crater_index_free(&index);
}

/* The deepest bowl counts; a rim never fills another's bowl. */
static void test_overlap_is_the_deepest_bowl_else_the_highest_rim(void **state)
{
    const struct crater craters[] = {{1000.0, 1000.0, 10.0f, 2.0f, 1},
                                     {1000.0, 1000.0, 10.0f, 5.0f, 1},
                                     {1012.0, 1000.0, 10.0f, 3.0f, 2}};
    struct crater_index index;
    (void)state;
    index_of(&index, craters, 3);
    assert_true(crater_offset(&index, 1000.0, 1000.0) == -5.0);
    assert_true(crater_offset(&index, 1012.0, 1000.0) == -3.0); /* the others' rims are here */
    assert_true(fabs(crater_offset(&index, 990.0, 1000.0) - 1.0) < 1e-12); /* the higher rim */
    crater_index_free(&index);
}

static void test_the_index_gives_the_same_as_the_whole_list(void **state)
{
    struct crater craters[MANY];
    struct crater_index index;
    uint64_t random = fixture_seed(1);
    (void)state;
    for (int i = 0; i < MANY; i++)
        craters[i] = random_crater(&random);
    index_of(&index, craters, MANY);
    for (int i = 0; i < 4000; i++) {
        double x = fixture_uniform(&random, 24800.0, 25200.0);
        double z = fixture_uniform(&random, 24800.0, 25200.0);
        assert_true(fabs(crater_offset(&index, x, z) - oracle_offset(craters, MANY, x, z)) < 1e-9);
    }
    crater_index_free(&index);
}

/* Where a crater changes the ground, it is near every point from which that is in reach. */
static void test_craters_in_reach_are_near(void **state)
{
    static struct crater craters[40];
    struct crater_index index;
    uint64_t random = fixture_seed(43);
    int far = 0;
    (void)state;
    for (int i = 0; i < 40; i++) {
        craters[i] = random_crater(&random);
        craters[i].x += fixture_uniform(&random, -900.0, 900.0);
    }
    index_of(&index, craters, 40);
    for (int i = 0; i < 20000; i++) {
        double x = fixture_uniform(&random, 24000.0, 26000.0), reach = 8.0;
        double z = fixture_uniform(&random, 24850.0, 25150.0);
        double to_x = x + fixture_uniform(&random, -5.6, 5.6);
        double to_z = z + fixture_uniform(&random, -5.6, 5.6);
        bool near = crater_index_near(&index, x, z, reach);
        assert_true(near || crater_offset(&index, to_x, to_z) == 0.0);
        far += !near;
    }
    assert_true(far > 5000);
    crater_index_free(&index);
}

static void test_a_walk_passes_all_craters_near(void **state)
{
    struct crater craters[MANY];
    struct crater_index index;
    uint64_t random = fixture_seed(5);
    (void)state;
    for (int i = 0; i < MANY; i++)
        craters[i] = random_crater(&random);
    index_of(&index, craters, MANY);
    for (int n = 0; n < 500; n++) {
        bool passed[MANY] = {false};
        double x = fixture_uniform(&random, 24850.0, 25150.0);
        double z = fixture_uniform(&random, 24850.0, 25150.0), reach = n % 7 * 20.0;
        struct crater_walk walk = crater_walk_begin(&index, x, z, reach);
        const struct crater *crater;
        while ((crater = crater_walk_next(&walk)) != NULL)
            passed[crater - craters] = true;
        for (int i = 0; i < MANY; i++)
            assert_true(passed[i] || hypot(craters[i].x - x, craters[i].z - z) > reach);
    }
    crater_index_update(&index, 0);
    struct crater_walk walk = crater_walk_begin(&index, 25000.0, 25000.0, 100.0);
    assert_null(crater_walk_next(&walk));
    crater_index_free(&index);
}

static void test_order_does_not_matter(void **state)
{
    struct crater craters[MANY], shuffled[MANY];
    struct crater_index index, other;
    uint64_t random = fixture_seed(2);
    (void)state;
    for (int i = 0; i < MANY; i++)
        craters[i] = shuffled[i] = random_crater(&random);
    for (uint64_t i = MANY - 1; i > 0; i--) {
        uint64_t j = fixture_random(&random) % (i + 1);
        struct crater swapped = shuffled[i];
        shuffled[i] = shuffled[j];
        shuffled[j] = swapped;
    }
    index_of(&index, craters, MANY);
    index_of(&other, shuffled, MANY);
    for (int i = 0; i < 4000; i++) {
        double x = fixture_uniform(&random, 24800.0, 25200.0);
        double z = fixture_uniform(&random, 24800.0, 25200.0);
        assert_true(crater_offset(&index, x, z) == crater_offset(&other, x, z));
    }
    crater_index_free(&index);
    crater_index_free(&other);
}

/* rows 3, 37: a crater on a border, or on a corner, is found from each square that it reaches */
static void test_craters_on_borders_are_found_from_every_side(void **state)
{
    const struct crater craters[] = {{25000.0, 25000.0, 20.0f, 5.0f, 1},
                                     {25124.0, 24000.0, 2.0f, 1.0f, 1},
                                     {0.0, 0.0, 20.0f, 5.0f, 1},
                                     {WORLD_SIDE_DEFAULT_M, WORLD_SIDE_DEFAULT_M, 20.0f, 5.0f, 1}};
    struct crater_index index;
    (void)state;
    index_of(&index, craters, 4);
    for (int turn = 0; turn < 360; turn++) {
        double x = 25000.0 + 10.0 * cos(turn * RAD_PER_DEG);
        double z = 25000.0 + 10.0 * sin(turn * RAD_PER_DEG);
        assert_true(crater_offset(&index, x, z) < -3.0);
    }
    assert_true(crater_offset(&index, 25126.5, 24000.0) > 0.0); /* only its rim crosses */
    assert_true(crater_offset(&index, 3.0, 3.0) < -4.0);
    assert_true(crater_offset(&index, -3.0, -3.0) < -4.0); /* the edge's ground goes on outside */
    assert_true(crater_offset(&index, WORLD_SIDE_DEFAULT_M + 3.0, WORLD_SIDE_DEFAULT_M - 3.0) <
                -4.0);
    crater_index_free(&index);
}

static void test_index_grows_with_the_list_and_goes_back_with_it(void **state)
{
    struct crater craters[MANY];
    struct crater_index index, fresh;
    uint64_t random = fixture_seed(3);
    (void)state;
    for (int i = 0; i < MANY; i++)
        craters[i] = random_crater(&random);
    index_of(&index, craters, 1);
    for (uint32_t count = 1; count <= MANY; count += 7)
        crater_index_update(&index, count);
    for (int round = 0; round < 20; round++) {
        uint32_t count = (uint32_t)(fixture_random(&random) % (MANY + 1));
        crater_index_update(&index, count);
        assert_int_equal(index.count, count);
        index_of(&fresh, craters, count);
        for (int i = 0; i < 500; i++) {
            double x = fixture_uniform(&random, 24800.0, 25200.0);
            double z = fixture_uniform(&random, 24800.0, 25200.0);
            assert_true(crater_offset(&index, x, z) == crater_offset(&fresh, x, z));
        }
        assert_int_equal(index.link_count, fresh.link_count); /* nothing is kept of the past */
        crater_index_free(&fresh);
    }
    crater_index_free(&index);
}

/* A munition that digs but has no charge leaves a crater of no size, not a hole in the numbers. */
static void test_crater_of_no_size_changes_nothing(void **state)
{
    const struct crater crater = {1000.0, 2000.0, 0.0f, 0.0f, 1};
    struct crater_index index;
    (void)state;
    index_of(&index, &crater, 1);
    assert_true(crater_offset(&index, 1000.0, 2000.0) == 0.0);
    assert_true(crater_offset(&index, 1000.0, 2001.0) == 0.0);
    assert_true(crater_offset(&index, 1001.0, 2001.0) == 0.0);
    crater_index_free(&index);
}

/* Entries past the committed count are somebody's unfinished frame. */
static void test_entries_past_the_count_do_not_count(void **state)
{
    const struct crater craters[] = {{1000.0, 1000.0, 10.0f, 4.0f, 1},
                                     {2000.0, 1000.0, 10.0f, 4.0f, 2}};
    struct crater_index index;
    (void)state;
    index_of(&index, craters, 1);
    assert_true(crater_offset(&index, 2000.0, 1000.0) == 0.0);
    crater_index_update(&index, 2);
    assert_true(crater_offset(&index, 2000.0, 1000.0) == -4.0);
    crater_index_free(&index);
}

/* A tank of 7 m by 3.6 m in the middle of a bowl stands on its corners, and on the rim beside it.
 */
static void test_a_vehicle_is_lifted_over_bowl_and_rim(void **state)
{
    const struct crater crater = {1000.0, 2000.0, 5.0f, 2.0f, 1};
    struct crater_footing footing = {1000.0, 2000.0, 3.5, 1.8, 0.0, 1.0};
    struct crater_index index;
    (void)state;
    index_of(&index, &crater, 1);
    double corner = crater_offset(&index, 1001.8, 2003.5);
    assert_true(fabs(crater_lift(&index, &footing) - (corner + 2.0)) < 1e-12);
    footing.sine = footing.cosine = sqrt(0.5); /* the bowl is round */
    assert_true(fabs(crater_lift(&index, &footing) - (corner + 2.0)) < 1e-9);
    footing.x = 1008.0; /* its corners are outside, its middle is on the slope of the rim */
    assert_true(crater_lift(&index, &footing) >= 0.0);
    footing.x = 1020.0;
    assert_true(crater_lift(&index, &footing) == 0.0);
    crater_index_free(&index);
}

/* Wherever a vehicle stands, no corner and no middle of a side is below the craters. */
static void test_no_corner_is_in_a_crater(void **state)
{
    uint64_t random = fixture_seed(77);
    struct crater craters[MANY];
    struct crater_index index;
    (void)state;
    for (int i = 0; i < 12; i++)
        craters[i] = random_crater(&random);
    index_of(&index, craters, 12);
    for (int i = 0; i < 2000; i++) {
        double heading = fixture_uniform(&random, 0.0, 6.28);
        const struct crater_footing on = {fixture_uniform(&random, 24900.0, 25100.0),
                                          fixture_uniform(&random, 24900.0, 25100.0),
                                          3.5,
                                          1.8,
                                          sin(heading),
                                          cos(heading)};
        double at[3][3];
        for (int k = 0; k < 9; k++) {
            double along = 3.5 * (k / 3 - 1), across = 1.8 * (k % 3 - 1);
            at[k / 3][k % 3] = crater_offset(&index, on.x + on.sine * along + on.cosine * across,
                                             on.z - on.cosine * along + on.sine * across);
        }
        double y = at[1][1] + crater_lift(&index, &on);
        for (int k = 0; k < 9; k++)
            assert_true(at[k / 3][k % 3] <= y + 0.5 * (k / 3 - 1) * (at[2][1] - at[0][1]) +
                                                0.5 * (k % 3 - 1) * (at[1][2] - at[1][0]) + 1e-9);
    }
    crater_index_free(&index);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bowl_rim_and_untouched_ground),
        cmocka_unit_test(test_ground_is_continuous_across_the_crater),
        cmocka_unit_test(test_no_craters_no_change),
        cmocka_unit_test(test_overlap_is_the_deepest_bowl_else_the_highest_rim),
        cmocka_unit_test(test_the_index_gives_the_same_as_the_whole_list),
        cmocka_unit_test(test_craters_in_reach_are_near),
        cmocka_unit_test(test_a_walk_passes_all_craters_near),
        cmocka_unit_test(test_order_does_not_matter),
        cmocka_unit_test(test_craters_on_borders_are_found_from_every_side),
        cmocka_unit_test(test_index_grows_with_the_list_and_goes_back_with_it),
        cmocka_unit_test(test_crater_of_no_size_changes_nothing),
        cmocka_unit_test(test_entries_past_the_count_do_not_count),
        cmocka_unit_test(test_a_vehicle_is_lifted_over_bowl_and_rim),
        cmocka_unit_test(test_no_corner_is_in_a_crater),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
