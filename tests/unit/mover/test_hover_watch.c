/* Helicopters that hover alone rest until an aircraft comes near them. */
#include "mover/hover_watch.h"
#include "tests/support/fixture.h"
#include "tests/support/steps.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SECOND 60u

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

/* Puts a helicopter into the air that has the order to stand. */
static uint32_t hover(double x, double up_m)
{
    double height = FIXTURE_GROUND_M + steps_kind(&f, "helicopter")->cruise_altitude_m + up_m;
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = "helicopter", .at = {x, height, 25000.0}});
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_IDLE;
    return row;
}

static bool rests(uint32_t row)
{
    return f.stepper.mover.resting.resting[row / 64] >> row % 64 & 1;
}

static bool has_turns(uint32_t row)
{
    return f.stepper.mover.resting.turns[row / 64] >> row % 64 & 1;
}

/* Runs on until just after a frame in which those that hover burn their fuel. */
static void run_until_burnt(uint32_t row)
{
    double before = steps_rows(&f).row[row].fuel_l;
    for (uint32_t i = 0; i < 11 * SECOND && steps_rows(&f).row[row].fuel_l == before; i++)
        fixture_continue(&f, 1);
}

static void test_one_that_hovers_alone_has_no_turns(void **state)
{
    uint32_t alone = hover(25000.0, 3.0);
    (void)state;
    fixture_run(&f, 1);
    fixture_continue(&f, 20 * SECOND);
    assert_true(rests(alone) && !has_turns(alone));
    assert_true(hover_watch_hovers(&f.stepper.mover.resting.hovering, alone));
    double usual = steps_kind(&f, "helicopter")->cruise_altitude_m;
    assert_true(fabs(steps_rows(&f).row[alone].y - FIXTURE_GROUND_M - usual) < 0.006);
}

static void test_it_burns_the_fuel_of_ten_seconds_at_once(void **state)
{
    uint32_t alone = hover(25000.0, 0.0);
    const struct kind *kind = steps_kind(&f, "helicopter");
    (void)state;
    fixture_run(&f, 1);
    fixture_continue(&f, SECOND);
    run_until_burnt(alone);
    double before = steps_rows(&f).row[alone].fuel_l;
    assert_true(rests(alone) && !has_turns(alone));
    fixture_continue(&f, 10 * SECOND - 1);
    assert_true(steps_rows(&f).row[alone].fuel_l == before);
    fixture_continue(&f, 1);
    double burnt = before - steps_rows(&f).row[alone].fuel_l;
    assert_true(fabs(burnt - 10.0 * 0.2 * kind->fuel_lps) < 1e-9);
    assert_true(rests(alone) && !has_turns(alone));
}

static void test_a_low_tank_brings_it_down(void **state)
{
    uint32_t alone = hover(25000.0, 0.0);
    (void)state;
    steps_rows(&f).row[alone].fuel_l = steps_kind(&f, "helicopter")->fuel_lps;
    fixture_run(&f, 1);
    fixture_continue(&f, 12 * SECOND);
    assert_true(steps_rows(&f).row[alone].y < FIXTURE_GROUND_M + 20.0);
    assert_true(steps_rows(&f).row[alone].flags &
                ENTITY_FLAG_LANDED); /* where it is filled again */
}

static void test_an_aircraft_that_comes_near_wakes_it(void **state)
{
    uint32_t alone = hover(25000.0, 0.0), far = hover(20000.0, 0.0);
    (void)state;
    fixture_run(&f, 1);
    fixture_continue(&f, 25 * SECOND); /* no fuel is burnt while the other passes */
    assert_true(rests(alone) && rests(far));
    struct entities e = steps_rows(&f);
    struct vec3 at = entities_position(&e, alone);
    at.x -= 250.0;
    at.z += 12.0;
    fixture_put(
        &f, (struct fixture_entity){.kind = "helicopter", .at = at, .velocity = {30.0, 0.0, 0.0}});
    fixture_run(&f, 1); /* the mover forgets which rows rest */
    fixture_continue(&f, SECOND);
    assert_true(rests(alone) && !has_turns(alone));
    fixture_continue(&f, 410); /* the other holds its course, and is 30 m before it */
    assert_false(rests(alone));
    assert_true(fabs(steps_rows(&f).row[alone].y - at.y) > 0.5);
    fixture_continue(&f, 40 * SECOND);
    assert_true(rests(alone) && !has_turns(alone) && rests(far));
    assert_true(fabs(steps_rows(&f).row[alone].y - at.y) < 0.02);
}

static void test_those_that_hover_near_each_other_come_to_rest(void **state)
{
    uint32_t one = hover(25000.0, 0.0), other = hover(25015.0, 0.0);
    uint32_t three[] = {hover(20000.0, 0.0), hover(20015.0, 0.0), hover(20007.0, 0.5)};
    (void)state;
    fixture_run(&f, 1);
    fixture_continue(&f, 60 * SECOND);
    struct entities e = steps_rows(&f);
    assert_true(rests(one) && rests(other) && has_turns(one) && has_turns(other));
    assert_true(fabs(e.row[one].y - e.row[other].y) > 10.0);
    for (int n = 0; n < 3; n++)
        assert_true(rests(three[n]) && has_turns(three[n]));
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_one_that_hovers_alone_has_no_turns),
        TEST(test_it_burns_the_fuel_of_ten_seconds_at_once),
        TEST(test_a_low_tank_brings_it_down),
        TEST(test_an_aircraft_that_comes_near_wakes_it),
        TEST(test_those_that_hover_near_each_other_come_to_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
