/* The rules of brute, occupancy, hopcroft and mps, one at a time (thesis rows 42, 44, 45). Random
 * worlds are in tests/property/collider/test_method.c, npsnet2 in test_method_npsnet2.c. */
#include "collider/method/method.h"

#include "tests/support/pair_search.h"
#include "tests/support/small_world.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define ROWS 4096

static struct small_world w;

/* Methods that find candidates along the path. */
static method_pairs_function *const swept[] = {method_brute_pairs, method_occupancy_pairs,
                                               method_hopcroft_pairs};

#define SWEPT_COUNT (sizeof swept / sizeof swept[0])

static int open_world(void **state)
{
    (void)state;
    small_world_begin(&w, ROWS, 64);
    return pair_search_open(&w, ROWS * ROWS);
}

static const struct vec3 still = {0, 0, 0};

/* All three find this many pairs. */
static void assert_swept(uint32_t count)
{
    for (size_t i = 0; i < SWEPT_COUNT; i++)
        assert_int_equal(pair_search_run(swept[i]), count);
}

/* --- choosing ----------------------------------------------------------------------------------*/

static void test_every_method_has_its_function(void **state)
{
    (void)state;
    assert_ptr_equal(method_of(METHOD_SWEPT)->pairs, method_swept_pairs);
    assert_ptr_equal(method_of(METHOD_NPSNET2)->pairs, method_npsnet2_pairs);
    assert_ptr_equal(method_of(METHOD_MPS)->pairs, method_mps_pairs);
    assert_ptr_equal(method_of(METHOD_OCCUPANCY)->pairs, method_occupancy_pairs);
    assert_ptr_equal(method_of(METHOD_HOPCROFT)->pairs, method_hopcroft_pairs);
    assert_ptr_equal(method_of(METHOD_BRUTE)->pairs, method_brute_pairs);
    for (uint32_t method = 0; method < METHOD_COUNT; method++)
        assert_true(method_discrete((enum method)method) ==
                    (method == METHOD_NPSNET2 || method == METHOD_MPS));
}

static void test_pairs_are_appended_to_the_list(void **state)
{
    (void)state;
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, (struct vec3){1, 0, 0});
    small_world_row(&w, SMALL_TANK, (struct vec3){25001, 0, 25000}, still);
    const struct method_input input = small_world_input(&w);
    pair_list_add(&pair_search.pairs, 7, 8);
    for (size_t i = 0; i < SWEPT_COUNT; i++) {
        swept[i](&input, pair_search.workspace, &pair_search.pairs);
        assert_int_equal(pair_search.pairs.count, i + 2);
    }
    assert_true(pair_search_has(7, 8));
}

/* --- moving bodies -----------------------------------------------------------------------------*/

static void test_an_empty_world_has_no_pairs(void **state)
{
    (void)state;
    assert_swept(0);
    small_world_tree(&w, (struct vec3){25000, 0, 25000}, 2.0);
    assert_swept(0);
    assert_int_equal(pair_search_run(method_mps_pairs), 0);
}

static void test_two_at_rest_are_no_pair_and_one_that_moves_makes_it_one(void **state)
{
    (void)state;
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, still);
    small_world_row(&w, SMALL_TANK, (struct vec3){25003, 0, 25000}, still);
    assert_swept(0);
    w.path[1].along.x = 1e-12;
    assert_swept(1);
}

static void test_a_free_row_meets_nothing(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, (struct vec3){1, 0, 0});
    w.e.row[0].state = ENTITY_FREE;
    small_world_tree(&w, (struct vec3){25000, 0, 25000}, 2.0);
    assert_swept(3); /* the two with each other, and each with the tree */
    pair_search_run(method_hopcroft_pairs);
    assert_true(pair_search_has(1, 2) && pair_search_has(1, 0 | PAIR_FIXED) &&
                pair_search_has(2, 0 | PAIR_FIXED));
}

static void test_a_round_and_its_shooter_are_apart(void **state)
{
    (void)state;
    uint32_t tank = small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, still);
    uint32_t round =
        small_world_row(&w, SMALL_ROUND, (struct vec3){25001, 0, 25000}, (struct vec3){20, 0, 0});
    assert_swept(1);
    w.e.row[round].owner_slot = tank;
    w.e.row[round].owner_id = w.e.row[tank].id;
    assert_swept(0);
}

static void test_height_separates(void **state)
{
    (void)state;
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, (struct vec3){1, 0, 0});
    small_world_row(&w, SMALL_JET, (struct vec3){25000, 40, 25000}, (struct vec3){1, 0, 0});
    assert_swept(0);
    small_world_move(&w, 1, (struct vec3){25000, 40, 25000}, (struct vec3){1, -32, 0});
    assert_swept(1);
}

/* A path over the whole world, among grains of sand: it needs no cell of theirs. */
static void test_row_44_a_long_path_among_grains_is_found_and_costs_little(void **state)
{
    (void)state;
    small_world_row(&w, SMALL_GIANT, (struct vec3){0, 0, 25000}, (struct vec3){50000, 0, 3000});
    for (uint32_t i = 1; i < ROWS; i++)
        small_world_row(&w, SMALL_GRAIN, (struct vec3){12.0 * i, 0, 25000.0 + 0.5 * i}, still);
    assert_swept(ROWS - 1);
}

static float edge_of(const struct path_box *box, int axis, bool far)
{
    const float low[] = {box->min_x, box->min_y, box->min_z};
    const float high[] = {box->max_x, box->max_y, box->max_z};
    return (far ? high : low)[axis];
}

/* Boxes are floats: the second tank goes where its near edge is the first one's far edge to the
 * bit. */
static void put_edge_to_edge(int axis)
{
    const struct method_input input = small_world_input(&w);
    struct path_box first = pair_filter_box(&input, 0), second;
    double low = 0.0, high = 20.0;
    do {
        double middle = 0.5 * (low + high);
        struct vec3 at = {25000, 0, 25000};
        *(axis == 0 ? &at.x : axis == 1 ? &at.y : &at.z) += middle;
        small_world_move(&w, 1, at, still);
        second = pair_filter_box(&input, 1);
        *(edge_of(&second, axis, false) < edge_of(&first, axis, true) ? &low : &high) = middle;
    } while (edge_of(&second, axis, false) != edge_of(&first, axis, true));
}

static void test_row_45_boxes_that_only_touch_meet(void **state)
{
    (void)state;
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, (struct vec3){1, 1, 1});
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, still);
    for (int axis = 0; axis < 3; axis++) {
        put_edge_to_edge(axis);
        assert_swept(1);
        *(axis == 0 ? &w.path[1].at.x : axis == 1 ? &w.path[1].at.y : &w.path[1].at.z) += 0.01;
        assert_swept(0);
    }
}

/* --- fixed objects -----------------------------------------------------------------------------*/

static void test_what_is_down_or_rests_is_not_tested(void **state)
{
    (void)state;
    small_world_tree(&w, (struct vec3){25000, 0, 25000}, 2.0);
    small_world_row(&w, SMALL_TANK, (struct vec3){25003, 0, 25000}, still);
    assert_swept(0);
    w.path[0].along.x = 1.0;
    assert_swept(1);
    w.damage[0] = DAMAGE_HIGH;
    assert_swept(0);
}

static void test_row_17_above_the_threshold_only_munitions_are_tested(void **state)
{
    (void)state;
    small_world_tree(&w, (struct vec3){25000, 0, 25000}, 130.0);
    small_world_row(&w, SMALL_JET, (struct vec3){25000, 60.01, 25000}, (struct vec3){4, 0, 0});
    assert_swept(0);
    small_world_move(&w, 0, (struct vec3){25000, 59.99, 25000}, (struct vec3){4, 0, 0});
    assert_swept(1);
    small_world_empty(&w);
    small_world_tree(&w, (struct vec3){25000, 0, 25000}, 130.0);
    small_world_row(&w, SMALL_ROUND, (struct vec3){25000, 70, 25000}, (struct vec3){4, 0, 0});
    assert_swept(1);
}

/* --- mps ---------------------------------------------------------------------------------------*/

static void test_row_42_mps_finds_platforms_near_on_the_map_where_the_frame_ends(void **state)
{
    (void)state;
    w.params->collision.mps_near_m = 10.0;
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, (struct vec3){6, 0, 0});
    small_world_row(&w, SMALL_CAR, (struct vec3){25006, 0, 25010}, still);
    assert_int_equal(pair_search_run(method_mps_pairs), 1); /* at the end 10 m, at the start more */
    assert_true(pair_search_has(0, 1));
    small_world_move(&w, 0, (struct vec3){25000, 0, 25000}, (struct vec3){5.99, 0, 0});
    assert_int_equal(pair_search_run(method_mps_pairs), 0);
    /* It drives through the other, and is past it when the frame ends. */
    small_world_move(&w, 0, (struct vec3){24990, 0, 25010}, (struct vec3){30, 0, 0});
    assert_int_equal(pair_search_run(method_mps_pairs), 0);
}

static void test_row_42_mps_looks_at_no_height(void **state)
{
    (void)state;
    w.params->collision.mps_near_m = 10.0;
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, still);
    small_world_row(&w, SMALL_JET, (struct vec3){24900, 5000, 25000}, (struct vec3){100, 0, 0});
    assert_int_equal(pair_search_run(method_mps_pairs), 1);
}

static void test_row_42_mps_checks_nothing_but_platforms(void **state)
{
    (void)state;
    w.params->collision.mps_near_m = 10.0;
    small_world_tree(&w, (struct vec3){25000, 0, 25000}, 2.0);
    small_world_row(&w, SMALL_ROUND, (struct vec3){25000, 0, 25000}, (struct vec3){1, 0, 0});
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, (struct vec3){1, 0, 0});
    assert_int_equal(pair_search_run(method_mps_pairs), 0);
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, still);
    assert_int_equal(pair_search_run(method_mps_pairs), 1);
    assert_true(pair_search_has(1, 2));
    w.path[1].along.x = 0.0; /* no further body comes near */
    assert_int_equal(pair_search_run(method_mps_pairs), 0);
    w.path[1].along.x = 1.0;
    w.e.row[2].state = ENTITY_FREE;
    assert_int_equal(pair_search_run(method_mps_pairs), 0);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, pair_search_teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_every_method_has_its_function),
        TEST(test_pairs_are_appended_to_the_list),
        TEST(test_an_empty_world_has_no_pairs),
        TEST(test_two_at_rest_are_no_pair_and_one_that_moves_makes_it_one),
        TEST(test_a_free_row_meets_nothing),
        TEST(test_a_round_and_its_shooter_are_apart),
        TEST(test_height_separates),
        TEST(test_row_44_a_long_path_among_grains_is_found_and_costs_little),
        TEST(test_row_45_boxes_that_only_touch_meet),
        TEST(test_what_is_down_or_rests_is_not_tested),
        TEST(test_row_17_above_the_threshold_only_munitions_are_tested),
        TEST(test_row_42_mps_finds_platforms_near_on_the_map_where_the_frame_ends),
        TEST(test_row_42_mps_looks_at_no_height),
        TEST(test_row_42_mps_checks_nothing_but_platforms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
