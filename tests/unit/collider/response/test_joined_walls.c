/* Walls that are joined to a struck one respond too (thesis p. 15). */
#include "collider/response/joined_walls.h"
#include "tests/support/steps.h"
#include "world/params.h"
#include "world/terrain/fixed.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;

/* Walls of 10 m by 1 m from west to east, end to end: 0, 1 and 2 are a row, 3 is a bunker that
 * touches the last of them, and 4 a wall 40 m further. All are in one gridsquare, and so in this
 * order. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"building\"; at = [25020.0, 25050.0]; },\n"
                     "            { kind = \"building\"; at = [25030.1, 25050.0]; },\n"
                     "            { kind = \"building\"; at = [25040.2, 25050.0]; },\n"
                     "            { kind = \"bunker\"; at = [25049.7, 25050.0]; },\n"
                     "            { kind = \"building\"; at = [25080.0, 25050.0]; } );\n");
    struct kind *wall = steps_kind(&f, "building");
    wall->length_m = 1.0;
    wall->width_m = 10.0;
    wall->resistance_j = 1e6;
    for (uint32_t n = 0; n < 5; n++)
        ((struct fixed_object *)(uintptr_t)f.view.world.fixed)[n].turn = 0;
    return 0;
}

static bool touch(struct fixed_object p, struct fixed_object q)
{
    bool touches = joined_walls_touch(&p, &q, f.view.world.kinds);
    assert_int_equal(touches, joined_walls_touch(&q, &p, f.view.world.kinds));
    return touches;
}

static void test_footprints_that_are_nearer_than_the_gap_touch(void **state)
{
    (void)state;
    struct fixed_object p = f.view.world.fixed[0], q = p;
    q.x = p.x + 10.0 + 0.9 * JOINED_WALLS_GAP_M;
    assert_true(touch(p, q));
    q.x = p.x + 10.0 + 1.1 * JOINED_WALLS_GAP_M;
    assert_false(touch(p, q));
    q.x = p.x;
    q.z = p.z + 1.0 + 0.9 * JOINED_WALLS_GAP_M;
    assert_true(touch(p, q));
    q.z = p.z + 1.0 + 1.1 * JOINED_WALLS_GAP_M;
    assert_false(touch(p, q));
    q.turn = 16384; /* a corner: the second wall goes from the first one's end to the south */
    q.x = p.x + 4.5;
    q.z = p.z + 5.5;
    assert_true(touch(p, q));
    q.z = p.z + 6.0;
    assert_false(touch(p, q));
}

/* Drives a tank of 57 t north into the middle of wall n at this speed. */
static uint32_t ram(uint32_t n, double speed_mps)
{
    const struct fixed_object *wall = &f.view.world.fixed[n];
    steps_kind(&f, "tank")->resistance_j = 1e12;
    uint32_t row = fixture_put(
        &f, (struct fixture_entity){.kind = "tank",
                                    .at = {wall->x, 100.0, wall->z + (double)wall->radius_m + 3.01},
                                    .velocity = {0.0, 0.0, -speed_mps}});
    fixture_run(&f, 1);
    return row;
}

static enum damage damage_of(uint32_t n)
{
    return (enum damage)fixture_state(&f).fixed_damage[n];
}

/* The energy of the tank at the speed that gives it joules. */
static double speed_for(double joules)
{
    return sqrt(2.0 * joules / steps_kind(&f, "tank")->mass_kg);
}

static void test_both_neighbours_take_their_share(void **state)
{
    (void)state;
    ram(1, speed_for(1.0e6)); /* 750 kJ to the wall, 125 kJ to each neighbour */
    assert_int_equal(damage_of(1), DAMAGE_MED);
    assert_int_equal(damage_of(0), DAMAGE_LOW);
    assert_int_equal(damage_of(2), DAMAGE_LOW);
    assert_int_equal(damage_of(3), DAMAGE_NONE);
    assert_int_equal(damage_of(4), DAMAGE_NONE);
}

static void test_a_lone_wall_takes_all(void **state)
{
    (void)state;
    ram(4, speed_for(1.001e6));
    assert_int_equal(damage_of(4), DAMAGE_HIGH);
    assert_int_equal(damage_of(2), DAMAGE_NONE);
}

/* A joined wall stands until it and its neighbours have what breaks it: 1 MJ over three quarters.
 */
static void test_a_wall_at_the_end_has_one_neighbour(void **state)
{
    (void)state;
    ram(2, speed_for(1.0e6)); /* 250 kJ to the wall beside it; the bunker is no wall */
    assert_int_equal(damage_of(2), DAMAGE_MED);
    assert_int_equal(damage_of(1), DAMAGE_LOW);
    assert_int_equal(damage_of(0), DAMAGE_NONE);
    assert_int_equal(damage_of(3), DAMAGE_NONE);
}

/* A joined wall stands until it and its neighbours have what breaks it: 1 MJ over three quarters.
 */
static void test_a_joined_wall_is_held_by_its_neighbours(void **state)
{
    (void)state;
    uint32_t row = ram(1, speed_for(1.3e6));
    assert_int_equal(damage_of(1), DAMAGE_MED);
    assert_true(steps_rows(&f).row[row].vz >= 0.0); /* it was stopped */
}

static void test_neighbours_of_what_breaks_take_no_more_than_breaking_takes(void **state)
{
    (void)state;
    ram(1, speed_for(50e6));
    assert_int_equal(damage_of(1), DAMAGE_HIGH);
    assert_int_equal(damage_of(0), DAMAGE_LOW); /* a sixth of 1 MJ, not an eighth of 50 MJ */
    assert_int_equal(damage_of(2), DAMAGE_LOW);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_footprints_that_are_nearer_than_the_gap_touch),
        TEST(test_both_neighbours_take_their_share),
        TEST(test_a_lone_wall_takes_all),
        TEST(test_a_wall_at_the_end_has_one_neighbour),
        TEST(test_a_joined_wall_is_held_by_its_neighbours),
        TEST(test_neighbours_of_what_breaks_take_no_more_than_breaking_takes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
