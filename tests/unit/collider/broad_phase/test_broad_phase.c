/* The broad phase's rules, one at a time. Random worlds are in
 * tests/property/collider/test_broad_phase.c. */
#include "collider/broad_phase/broad_phase.h"

#include "tests/support/steps.h"
#include "world/params.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static struct path path[64];

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static uint32_t put(const char *kind, struct vec3 at, struct vec3 along)
{
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = kind, .at = at});
    path[row] = (struct path){.at = at, .along = along};
    return row;
}

/* How often the pair is found; all: pairs in all. */
static uint32_t found(uint32_t a, uint32_t b, uint32_t *all)
{
    struct state now = fixture_state(&f);
    const struct method_input input = {.world = &f.view.world,
                                       .entities = &now.entities,
                                       .path = path,
                                       .fixed_damage = now.fixed_damage,
                                       .craters = &f.stepper.collider.craters,
                                       .rows = now.head->used};
    uint32_t times = 0;
    *all = 0;
    broad_phase_pairs(&f.stepper.collider.broad, &input);
    for (int list = 0; list < THREAD_POOL_MAX; list++) {
        for (uint32_t n = 0; n < f.stepper.collider.broad.list[list].count; n++) {
            struct pair pair = f.stepper.collider.broad.list[list].pair[n];
            times += pair.a == a && pair.b == b;
            ++*all;
        }
    }
    return times;
}

static bool pairs(uint32_t a, uint32_t b)
{
    uint32_t all, times = found(a, b, &all);
    assert_true(times <= 1);
    return times == 1;
}

/* --- moving bodies -----------------------------------------------------------------------------*/

static void test_two_at_rest_are_no_pair_and_one_that_moves_makes_it_one(void **state)
{
    uint32_t a = put("tank", (struct vec3){25000, 100, 25000}, (struct vec3){0, 0, 0});
    uint32_t b = put("tank", (struct vec3){25003, 100, 25000}, (struct vec3){0, 0, 0});
    (void)state;
    assert_false(pairs(a, b));
    path[b].along.x = 1e-12;
    assert_true(pairs(a, b));
}

static void test_a_round_and_its_shooter_are_apart(void **state)
{
    struct entities e = steps_rows(&f);
    uint32_t tank = put("tank", (struct vec3){25000, 100, 25000}, (struct vec3){0, 0, 0});
    uint32_t round = put("shell", (struct vec3){25001, 100, 25000}, (struct vec3){20, 0, 0});
    uint32_t second = put("shell", (struct vec3){25002, 100, 25000}, (struct vec3){20, 0, 0});
    (void)state;
    e.row[round].owner_slot = e.row[second].owner_slot = tank;
    e.row[round].owner_id = e.row[second].owner_id = e.row[tank].id;
    assert_false(pairs(tank, round));
    assert_false(pairs(round, second)); /* two of one shooter */
    e.row[second].owner_id = 77;        /* the row's owner before */
    assert_true(pairs(tank, second));
    assert_true(pairs(round, second));
}

static void test_rounds_of_the_sky_can_meet(void **state)
{
    uint32_t a = put("bomb", (struct vec3){25000, 200, 25000}, (struct vec3){0, -4, 0});
    uint32_t b = put("bomb", (struct vec3){25000, 198, 25000}, (struct vec3){0, -4, 0});
    (void)state;
    assert_true(pairs(a, b)); /* owner 0 is no entity, so not a common owner */
}

static void test_height_separates(void **state)
{
    uint32_t a = put("tank", (struct vec3){25000, 100, 25000}, (struct vec3){1, 0, 0});
    uint32_t b = put("helicopter", (struct vec3){25000, 140, 25000}, (struct vec3){1, 0, 0});
    (void)state;
    assert_false(pairs(a, b));
    path[b].along.y = -32.0;
    assert_true(pairs(a, b));
}

/* --- fixed objects -----------------------------------------------------------------------------*/

/* A building, 9 m, 4 m east of a border of squares, and a tree on a corner of four. */
static const char objects[] = "objects = ( { kind = \"building\"; at = [25004.0, 25060.0]; },\n"
                              "            { kind = \"tree\"; at = [30000.0, 30000.0]; } );\n";

static void with_objects(void)
{
    fixture_close(&f);
    fixture_open(&f, objects);
}

static void test_row_37_an_object_that_reaches_over_the_border_is_found_there(void **state)
{
    (void)state;
    with_objects();
    /* West of the border all the time: only in the square in which the building's centre is not. */
    uint32_t row = put("jeep", (struct vec3){24994, 100, 25055}, (struct vec3){0, 0, 4});
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, 24994 + 1.6 + 0.01),
                     gridsquare_axis(&GRIDSQUARES_DEFAULT, 24994));
    assert_true(pairs(row, 0 | PAIR_FIXED));
}

static void test_row_37_an_object_in_four_squares_is_one_pair(void **state)
{
    uint32_t all;
    (void)state;
    with_objects();
    uint32_t row = put("tank", (struct vec3){29990, 100, 29990}, (struct vec3){20, 0, 20});
    assert_int_equal(found(row, 1 | PAIR_FIXED, &all), 1);
    assert_int_equal(all, 1);
}

static void test_row_3_objects_of_other_squares_are_left_alone(void **state)
{
    uint32_t all;
    (void)state;
    with_objects();
    put("tank", (struct vec3){27000, 100, 27000}, (struct vec3){60, 0, 60});
    found(0, 0, &all);
    assert_int_equal(all, 0);
}

static void test_what_is_down_or_rests_is_not_tested(void **state)
{
    (void)state;
    with_objects();
    uint32_t row = put("tank", (struct vec3){29997, 100, 30000}, (struct vec3){0, 0, 0});
    assert_false(pairs(row, 1 | PAIR_FIXED));
    path[row].along.x = 1.0;
    assert_true(pairs(row, 1 | PAIR_FIXED));
    fixture_state(&f).fixed_damage[1] = DAMAGE_MED;
    assert_true(pairs(row, 1 | PAIR_FIXED));
    fixture_state(&f).fixed_damage[1] = DAMAGE_HIGH;
    assert_false(pairs(row, 1 | PAIR_FIXED));
}

static void test_row_17_above_the_threshold_no_aircraft_is_tested_with_fixed_objects(void **state)
{
    (void)state;
    with_objects();
    steps_params(&f)->collision.threshold_height_m = 5.0; /* below the building's top */
    uint32_t row = put("helicopter", (struct vec3){25000, 105.01, 25060}, (struct vec3){4, 0, 0});
    assert_false(pairs(row, 0 | PAIR_FIXED));
    path[row].at.y = 104.99;
    assert_true(pairs(row, 0 | PAIR_FIXED));
    path[row].at.y = 105.01;
    path[row].along.y = -0.1; /* it comes down below */
    assert_true(pairs(row, 0 | PAIR_FIXED));
}

static double ridge(double x, double z, const void *context)
{
    (void)z, (void)context;
    return fabs(x - 25000.0) < 1.0 ? 160.0 : 100.0;
}

static void test_row_23_a_ridge_between_two_frames_brings_its_objects_near(void **state)
{
    (void)state;
    with_objects();
    /* At both ends 70 m above the ground, in between 10 m: the house on the crest is hit. */
    steps_ground(&f, ridge, NULL);
    ((struct fixed_object *)(uintptr_t)f.view.world.fixed)[0].y = 160.0f;
    uint32_t row = put("jet", (struct vec3){24850, 170, 25060}, (struct vec3){300, 0, 0});
    assert_true(pairs(row, 0 | PAIR_FIXED));
}

static void test_row_17_munitions_are_tested_at_any_height(void **state)
{
    (void)state;
    with_objects();
    steps_params(&f)->collision.threshold_height_m = 5.0;
    uint32_t row = put("bomb", (struct vec3){25004, 108, 25050}, (struct vec3){0, 0, 5});
    assert_true(pairs(row, 0 | PAIR_FIXED));
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_two_at_rest_are_no_pair_and_one_that_moves_makes_it_one),
        TEST(test_a_round_and_its_shooter_are_apart),
        TEST(test_rounds_of_the_sky_can_meet),
        TEST(test_height_separates),
        TEST(test_row_37_an_object_that_reaches_over_the_border_is_found_there),
        TEST(test_row_37_an_object_in_four_squares_is_one_pair),
        TEST(test_row_3_objects_of_other_squares_are_left_alone),
        TEST(test_what_is_down_or_rests_is_not_tested),
        TEST(test_row_17_above_the_threshold_no_aircraft_is_tested_with_fixed_objects),
        TEST(test_row_23_a_ridge_between_two_frames_brings_its_objects_near),
        TEST(test_row_17_munitions_are_tested_at_any_height),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
