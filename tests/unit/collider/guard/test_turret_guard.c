/* Turrets and guns in whole frames: what stops them, what they miss, and what they hit when their
 * tank drives. A building stands at 25000, 25000 with its long side, a plain wall, to the west. */
#include "collider/guard/turret_guard.h"

#include "tests/support/steps.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define WALL_X   24995.0
#define BESIDE_M 4.0 /* from the tank's middle to the wall: its gun is longer */
#define FAR_Z    25300.0
#define MUZZLE_M 5.95 /* from the turret's axis */
#define SECONDS  5

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };\n"
                     "objects = ( { kind = \"building\"; at = [25000.0, 25000.0]; } );");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

static uint32_t put(const char *kind, double x, double z, double heading_rad)
{
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                           .at = {x, FIXTURE_GROUND_M, z},
                                                           .heading_rad = heading_rad,
                                                           .behaviour = BEHAVIOUR_IDLE});
    steps_rows(&f).row[row].behaviour = BEHAVIOUR_IDLE;
    return row;
}

/* Turns the turret to the right at its full rate and raises the gun. */
static void train(uint32_t row, double traverse, double elevate)
{
    steps_command(&f, (struct command){.type = COMMAND_DRIVE,
                                       .entity = row + 1,
                                       .value = {0.0, 0.0, 0.0, traverse, elevate}});
}

static double turret(uint32_t row)
{
    return (double)steps_rows(&f).row[row].turret;
}

static double gun(uint32_t row)
{
    return (double)steps_rows(&f).row[row].gun;
}

/* Returns the angle at which the muzzle of a tank that heads north is at the wall. */
static double at_wall(void)
{
    return asin((BESIDE_M - 0.06) / MUZZLE_M);
}

/* --- turning -----------------------------------------------------------------------------------*/

static void test_a_turret_turns_freely_where_nothing_is(void **state)
{
    uint32_t tank = put("tank", WALL_X - 20.0, FAR_Z, 0.0);
    (void)state;
    train(tank, 1.0, 0.0);
    fixture_run(&f, 60 * SECONDS);
    assert_true(fabs(turret(tank)) > 2.5); /* 40 degrees a second */
}

static void test_a_gun_stops_at_the_wall_beside_its_tank(void **state)
{
    uint32_t tank = put("tank", WALL_X - BESIDE_M, 25000.0, 0.0);
    (void)state;
    train(tank, 1.0, 0.0);
    fixture_run(&f, 60 * SECONDS);
    double stopped = turret(tank);
    if (!(fabs(stopped - at_wall()) < 0.06))
        fail_msg("stopped at %g, the wall is at %g", stopped, at_wall());
    fixture_run(&f, 60);
    assert_true(turret(tank) == stopped);                         /* it does not creep */
    assert_true(steps_rows(&f).row[tank].x == WALL_X - BESIDE_M); /* and does not push its tank */
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    train(tank, -1.0, 0.0);
    fixture_run(&f, 30);
    assert_true(turret(tank) < stopped - 0.2);
}

static void test_a_gun_that_touches_the_wall_can_still_be_raised(void **state)
{
    uint32_t tank = put("tank", WALL_X - BESIDE_M, 25000.0, 0.0);
    (void)state;
    train(tank, 1.0, 0.3);
    fixture_run(&f, 60 * SECONDS);
    assert_true(fabs(turret(tank) - at_wall()) < 0.2 && gun(tank) > 0.3);
}

static void test_two_guns_stop_each_other(void **state)
{
    uint32_t one = put("tank", WALL_X - 40.0, FAR_Z, 0.0);
    uint32_t other = put("tank", WALL_X - 36.0, FAR_Z - 8.0, PI);
    (void)state;
    train(one, 1.0, 0.0);
    train(other, 1.0, 0.0);
    fixture_run(&f, 60 * SECONDS);
    assert_true(fabs(turret(one)) < 2.0 && fabs(turret(other)) < 2.0);
    double before = turret(one);
    fixture_run(&f, 60);
    assert_true(fabs(turret(one) - before) < 1e-3);
}

static void test_a_gun_passes_over_a_jeep_that_is_low(void **state)
{
    uint32_t tank = put("tank", WALL_X - 20.0, FAR_Z, 0.0);
    /* The barrel is at 1.66 m; the jeep's bonnet, in front of its windscreen, is below 1.1 m. */
    put("jeep", WALL_X - 20.0 + 6.7, FAR_Z + 0.2, PI + HALF_PI);
    (void)state;
    train(tank, 1.0, 0.0);
    fixture_run(&f, 60 * SECONDS);
    assert_true(fabs(turret(tank)) > 2.5);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
}

static void test_a_gun_stops_at_a_truck(void **state)
{
    uint32_t tank = put("tank", WALL_X - 20.0, FAR_Z, 0.0);
    put("truck", WALL_X - 20.0 + 5.2, FAR_Z, 0.0);
    (void)state;
    train(tank, 1.0, 0.0);
    fixture_run(&f, 60 * SECONDS);
    assert_true(turret(tank) > 0.2 && turret(tank) < HALF_PI);
}

/* --- driving -----------------------------------------------------------------------------------*/

/* Drives a tank north past the building, with its gun pointing to the right or forwards. */
static double passed(double turret_rad)
{
    uint32_t tank = fixture_put(
        &f, (struct fixture_entity){.kind = "tank",
                                    .at = {WALL_X - BESIDE_M, FIXTURE_GROUND_M, 25025.0},
                                    .velocity = {0.0, 0.0, -10.0}});
    steps_rows(&f).row[tank].turret = (float)turret_rad;
    steps_rows(&f).row[tank].target_id = 99; /* an agent without a target lays its gun to rest */
    fixture_run(&f, 60 * SECONDS);
    return steps_rows(&f).row[tank].z;
}

static void test_a_tank_drives_past_a_wall_with_its_gun_ahead(void **state)
{
    (void)state;
    assert_true(fabs(passed(0.0) - (25025.0 - 10.0 * SECONDS)) < 1.0);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
}

static void test_a_tank_hits_the_wall_with_its_gun_to_the_side(void **state)
{
    (void)state;
    passed(HALF_PI);
    assert_true(fixture_event_count(&f, EVENT_COLLISION) > 0);
    const struct event *event = fixture_event(&f, EVENT_COLLISION, 0);
    assert_true(event->collision.point[2] > 25007.0 && event->collision.point[0] > WALL_X);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_a_turret_turns_freely_where_nothing_is, open_world,
                                        close_world),
        cmocka_unit_test_setup_teardown(test_a_gun_stops_at_the_wall_beside_its_tank, open_world,
                                        close_world),
        cmocka_unit_test_setup_teardown(test_a_gun_that_touches_the_wall_can_still_be_raised,
                                        open_world, close_world),
        cmocka_unit_test_setup_teardown(test_two_guns_stop_each_other, open_world, close_world),
        cmocka_unit_test_setup_teardown(test_a_gun_passes_over_a_jeep_that_is_low, open_world,
                                        close_world),
        cmocka_unit_test_setup_teardown(test_a_gun_stops_at_a_truck, open_world, close_world),
        cmocka_unit_test_setup_teardown(test_a_tank_drives_past_a_wall_with_its_gun_ahead,
                                        open_world, close_world),
        cmocka_unit_test_setup_teardown(test_a_tank_hits_the_wall_with_its_gun_to_the_side,
                                        open_world, close_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
