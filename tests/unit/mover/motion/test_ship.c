/* Ships keep to the water. */
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ 10.0

static struct fixture f;

/* A lake of 6 km by 6 km. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 10.0; };");
    steps_cover(&f, COVER_LAKE, 22000.0, 22000.0, 28000.0, 28000.0);
    return 0;
}

static bool on_water(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return cover_is_water(terrain_cover(&f.view.world.terrain, e.x[row], e.z[row]));
}

static uint32_t put_ship(double x, double z, double speed_mps)
{
    return fixture_put(&f, (struct fixture_entity){.kind = "ship",
                                                   .at = {x, FIXTURE_GROUND_M, z},
                                                   .velocity = {speed_mps, 0.0, 0.0},
                                                   .heading_rad = HALF_PI});
}

static void test_patrolling_ships_never_leave_the_water(void **state)
{
    uint32_t row[8];
    (void)state;
    for (uint32_t n = 0; n < 8; n++) {
        row[n] = put_ship(23000.0 + 600.0 * n, 22200.0 + 700.0 * n, 5.0);
        struct entities e = steps_rows(&f);
        e.behaviour[row[n]] = e.order[row[n]] = BEHAVIOUR_PATROL; /* the whole world, mostly land */
    }
    for (int frame = 0; frame < (int)(600.0 * HZ); frame++) {
        fixture_run(&f, 1);
        for (uint32_t n = 0; n < 8; n++) {
            assert_true(on_water(row[n]));
            assert_true(steps_rows(&f).y[row[n]] == FIXTURE_GROUND_M);
        }
    }
}

/* The shore is half way to the next post. Friction stops the ship within v2 / 2 0.7 g. */
static void test_the_shore_stops_a_ship_by_its_bow(void **state)
{
    const double shore = 28062.5, fast = 13.0, hardest = 0.7 * GRAVITY_MPS2 + 1e-9;
    uint32_t row = put_ship(27500.0, 25010.0, fast);
    double before = fast;
    (void)state;
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    for (int frame = 0; frame < (int)(90.0 * HZ); frame++) {
        fixture_run(&f, 1);
        assert_true(before - steps_speed(&f, row) <= hardest / HZ);
        before = steps_speed(&f, row);
    }
    double bow = steps_rows(&f).x[row] + 0.5 * steps_kind(&f, "ship")->length_m;
    assert_true(bow > shore + 10.0 && bow < shore + 15.0);
    assert_true(on_water(row));
    assert_true(steps_speed(&f, row) == 0.0);
}

static void test_a_ship_that_is_aground_goes_astern(void **state)
{
    uint32_t row = put_ship(27900.0, 25010.0, 13.0);
    (void)state;
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(30.0 * HZ));
    assert_true(steps_speed(&f, row) == 0.0);
    steps_pedals(&f, row, 1.0, 0.0, GEAR_REVERSE);
    fixture_run(&f, (uint32_t)(60.0 * HZ));
    double bow = steps_rows(&f).x[row] + 0.5 * steps_kind(&f, "ship")->length_m;
    assert_true(bow < 28000.0 && steps_rows(&f).vx[row] < -5.0);
}

static void test_a_ship_lies_level_and_is_slow_to_gain_speed(void **state)
{
    uint32_t row = put_ship(23000.0, 25010.0, 0.0);
    const struct kind *kind = steps_kind(&f, "ship");
    (void)state;
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(10.0 * HZ) - 1);
    assert_true(fabs(steps_speed(&f, row) - 10.0 * kind->acceleration_mps2) < 1e-9);
    fixture_run(&f, (uint32_t)(30.0 * HZ));
    assert_true(fabs(steps_speed(&f, row) - kind->max_speed_mps) < 1e-9);
    assert_true(steps_rows(&f).pitch[row] == 0.0 && steps_rows(&f).roll[row] == 0.0);
}

static void test_the_rudder_bites_with_the_ships_way(void **state)
{
    double rate = steps_kind(&f, "ship")->turn_rate_rps;
    double full = steps_kind(&f, "ship")->max_speed_mps;
    uint32_t fast = put_ship(23000.0, 25010.0, full), still = put_ship(23000.0, 26010.0, 0.0);
    (void)state;
    steps_drive(&f, fast, 1.0, 1.0, 0.0);
    steps_drive(&f, still, 0.0, 1.0, 0.0);
    double before[2] = {steps_rows(&f).heading[fast], steps_rows(&f).heading[still]};
    fixture_run(&f, (uint32_t)(5.0 * HZ));
    double turned = maths_wrap_half(steps_rows(&f).heading[fast] - before[0]);
    assert_true(turned > 4.5 * rate && turned < 5.0 * rate + 1e-9);
    turned = maths_wrap_half(steps_rows(&f).heading[still] - before[1]);
    assert_true(turned > 0.0 && turned < 1.0 * rate);
}

static void test_a_ship_drifts_long_and_goes_astern(void **state)
{
    uint32_t drifts = put_ship(23000.0, 25010.0, 10.0), stops = put_ship(23000.0, 26010.0, 10.0);
    uint32_t back = put_ship(24000.0, 27010.0, 0.0);
    const struct kind *kind = steps_kind(&f, "ship");
    (void)state;
    steps_pedals(&f, drifts, 0.0, 0.0, GEAR_NEUTRAL);
    steps_pedals(&f, stops, 0.0, 1.0, GEAR_AUTOMATIC);
    steps_pedals(&f, back, 1.0, 0.0, GEAR_REVERSE);
    double before[2] = {steps_speed(&f, drifts), steps_speed(&f, stops)};
    fixture_run(&f, (uint32_t)(4.0 * HZ));
    double drag = 0.35 * kind->acceleration_mps2, screws = 2.0 * kind->acceleration_mps2;
    assert_true(fabs(before[0] - steps_speed(&f, drifts) - 4.0 * drag) < 1e-9);
    assert_true(fabs(before[1] - steps_speed(&f, stops) - 4.0 * screws) < 1e-9);
    fixture_run(&f, (uint32_t)(30.0 * HZ));
    assert_true(fabs(steps_rows(&f).vx[back] + 0.5 * kind->max_speed_mps) < 1e-9);
    assert_true(steps_speed(&f, stops) == 0.0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_patrolling_ships_never_leave_the_water),
        TEST(test_the_shore_stops_a_ship_by_its_bow),
        TEST(test_a_ship_that_is_aground_goes_astern),
        TEST(test_a_ship_lies_level_and_is_slow_to_gain_speed),
        TEST(test_the_rudder_bites_with_the_ships_way),
        TEST(test_a_ship_drifts_long_and_goes_astern),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
