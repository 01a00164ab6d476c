/* The ground that ends a way, and what steep ground costs. */
#include "mover/agent/driving/ground_obstacles.h"

#include "mover/context/serial_context.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define LENGTH_M 64.0
#define WORLD_M  50000.0

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

/* Returns how far a vehicle's way to the east is free, or what it costs. */
static double look(uint32_t row, bool cost)
{
    struct step_context step;
    struct serial_context serial;
    steps_serial_context(&f, &step, &serial);
    const struct ground_way way = {
        .ux = 1.0,
        .length_m = LENGTH_M,
        .beside_m = 2.0,
        .ahead_m = 4.0,
        .slope = ground_obstacles_slope(&f.view.world.kinds[steps_rows(&f).row[row].kind])};
    return cost ? ground_obstacles_cost(&step, row, &way) : ground_obstacles_free(&step, row, &way);
}

static uint32_t put(const char *kind, double x, enum behaviour order)
{
    return steps_put(&f, kind, (struct vec3){x, FIXTURE_GROUND_M, 25000.0}, FORCE_BLUE, order);
}

static void test_level_ground_is_free_and_costs_nothing(void **state)
{
    (void)state;
    uint32_t row = put("jeep", 25000.0, BEHAVIOUR_PATROL);
    assert_true(look(row, false) == LENGTH_M);
    assert_true(look(row, true) == 0.0);
}

static void test_the_edge_of_the_world_ends_a_way(void **state)
{
    (void)state;
    double free_m = look(put("jeep", WORLD_M - 20.0, BEHAVIOUR_PATROL), false);
    assert_true(free_m > 0.0 && free_m < 20.0);
}

/* The shore is at x = 25062.5. */
static void test_the_shore_ends_the_ways_of_vehicles_and_ships(void **state)
{
    (void)state;
    steps_cover(&f, COVER_LAKE, 25125.0, 0.0, WORLD_M, WORLD_M);
    uint32_t jeep = put("jeep", 25030.0, BEHAVIOUR_PATROL);
    double free_m = look(jeep, false);
    assert_true(free_m > 0.0 && free_m <= 32.5);
    assert_true(look(put("ship", 25200.0, BEHAVIOUR_PATROL), false) == LENGTH_M);
    assert_true(look(put("ship", 25030.0, BEHAVIOUR_PATROL), false) < LENGTH_M);
}

/* A slope to the east, of this tangent. */
static void tilt(double east)
{
    steps_plane(&f, east, 0.0);
    fixture_threads(&f, 1);
}

static void test_what_is_too_steep_for_a_kind_ends_its_way(void **state)
{
    (void)state;
    uint32_t jeep = put("jeep", 25000.0, BEHAVIOUR_PATROL);
    const double most = ground_obstacles_slope(steps_kind(&f, "jeep"));
    tilt(0.95 * most);
    assert_true(look(jeep, false) == LENGTH_M);
    tilt(1.05 * most);
    assert_true(look(jeep, false) == 0.0);
}

static void test_steep_ground_costs_patrols_alone(void **state)
{
    (void)state;
    uint32_t patrol = put("tank", 25000.0, BEHAVIOUR_PATROL);
    uint32_t route = put("tank", 25000.0, BEHAVIOUR_ROUTE);
    tilt(0.45);
    assert_true(look(patrol, true) == 0.0);
    tilt(0.5);
    const double costs = look(patrol, true);
    assert_true(costs > 0.4 && look(route, true) == 0.0);
    tilt(0.6);
    assert_true(look(patrol, true) > costs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_level_ground_is_free_and_costs_nothing, open_world,
                                        close_world),
        cmocka_unit_test_setup_teardown(test_the_edge_of_the_world_ends_a_way, open_world,
                                        close_world),
        cmocka_unit_test_setup_teardown(test_the_shore_ends_the_ways_of_vehicles_and_ships,
                                        open_world, close_world),
        cmocka_unit_test_setup_teardown(test_what_is_too_steep_for_a_kind_ends_its_way, open_world,
                                        close_world),
        cmocka_unit_test_setup_teardown(test_steep_ground_costs_patrols_alone, open_world,
                                        close_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
