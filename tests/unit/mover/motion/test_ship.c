/* Ships keep to the water. */
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

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

static void tell(const char *what, double low, double high, double ours)
{
    print_message("| %-44s | %5.1f to %5.1f | %7.2f |\n", what, low, high, ours);
    assert_true(ours >= low && ours <= high);
}

static void test_a_ship_lies_level_and_is_slow_to_gain_speed(void **state)
{
    uint32_t row = put_ship(23000.0, 25010.0, 0.0);
    const struct kind *kind = steps_kind(&f, "ship");
    (void)state;
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(10.0 * HZ) - 1);
    double gained = steps_speed(&f, row);
    assert_true(gained < 10.0 * kind->acceleration_mps2 && gained > 9.0 * kind->acceleration_mps2);
    fixture_run(&f, (uint32_t)(160.0 * HZ));
    assert_true(fabs(steps_speed(&f, row) - kind->max_speed_mps) < 0.1);
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
    assert_true(turned > 2.0 * rate && turned < 3.5 * rate); /* the rudder takes 4 s */
    assert_true(steps_rows(&f).roll[fast] < -0.03 && steps_rows(&f).roll[fast] > -0.08);
    turned = maths_wrap_half(steps_rows(&f).heading[still] - before[1]);
    assert_true(turned > 0.0 && turned < 1.0 * rate);
}

/* The circle of IMO's trials: full rudder at full speed. Tactical diameter: across the first course
 * after half a circle. Advance: along it after a quarter. */
static void circle(double rate, double *diameter, double *advance, double *lost)
{
    char world[64];
    (void)snprintf(world, sizeof world, "world = { seed = 1; capacity = 64; hz = %.1f; };", rate);
    fixture_close(&f);
    fixture_open(&f, world);
    steps_cover(&f, COVER_LAKE, 22000.0, 22000.0, 28000.0, 28000.0);
    double full = steps_kind(&f, "ship")->max_speed_mps;
    double length = steps_kind(&f, "ship")->length_m;
    uint32_t row = put_ship(23000.0, 25010.0, full);
    steps_drive(&f, row, 1.0, 1.0, 0.0);
    while (fabs(maths_wrap_half(steps_rows(&f).heading[row] - PI)) > 0.02)
        fixture_run(&f, 1);
    *advance = (steps_rows(&f).x[row] - 23000.0) / length;
    while (fabs(maths_wrap_half(steps_rows(&f).heading[row] - 1.5 * PI)) > 0.02)
        fixture_run(&f, 1);
    *diameter = (steps_rows(&f).z[row] - 25010.0) / length;
    fixture_run(&f, (uint32_t)(20.0 * rate));
    *lost = 100.0 * (1.0 - steps_speed(&f, row) / full);
}

static void test_its_circle_is_that_of_a_ship(void **state)
{
    double diameter[2], advance[2], lost[2];
    (void)state;
    circle(10.0, &diameter[0], &advance[0], &lost[0]);
    circle(60.0, &diameter[1], &advance[1], &lost[1]);
    tell("tactical diameter, lengths", 4.0, 6.0, diameter[0]);
    tell("advance, lengths (IMO: at most 4.5)", 2.0, 4.5, advance[0]);
    tell("speed lost in the circle, percent", 30.0, 50.0, lost[0]);
    tell("diameter at 60 Hz over that at 10 Hz", 0.97, 1.03, diameter[1] / diameter[0]);
}

static void test_it_stops_within_five_lengths(void **state)
{
    const struct kind *kind = steps_kind(&f, "ship");
    uint32_t row = put_ship(23000.0, 25010.0, kind->max_speed_mps);
    (void)state;
    steps_pedals(&f, row, 0.0, 1.0, GEAR_AUTOMATIC);
    fixture_run(&f, (uint32_t)(60.0 * HZ));
    assert_true(steps_speed(&f, row) == 0.0);
    tell("crash stop, lengths", 2.0, 5.0, (steps_rows(&f).x[row] - 23000.0) / kind->length_m);
}

static void test_a_ship_runs_on_and_goes_astern(void **state)
{
    uint32_t drifts = put_ship(23000.0, 25010.0, 10.0), back = put_ship(24000.0, 27010.0, 0.0);
    const struct kind *kind = steps_kind(&f, "ship");
    (void)state;
    steps_pedals(&f, drifts, 0.0, 0.0, GEAR_NEUTRAL);
    steps_pedals(&f, back, 1.0, 0.0, GEAR_REVERSE);
    fixture_run(&f, (uint32_t)(20.0 * HZ));
    assert_true(steps_speed(&f, drifts) > 5.0 && steps_speed(&f, drifts) < 8.0);
    fixture_run(&f, (uint32_t)(100.0 * HZ));
    tell("way in 2 minutes without engines, lengths", 7.0, 20.0,
         (steps_rows(&f).x[drifts] - 23000.0) / kind->length_m);
    assert_true(fabs(steps_rows(&f).vx[back] + 0.5 * kind->max_speed_mps) < 0.05);
}

static void test_an_agent_steers_without_swinging(void **state)
{
    (void)state;
    uint32_t row = put_ship(23000.0, 25010.0, 10.0);
    struct entities e = steps_rows(&f);
    e.behaviour[row] = e.order[row] = BEHAVIOUR_PATROL;
    double beyond = 0.0;
    for (int frame = 0; frame < (int)(120.0 * HZ); frame++) {
        e = steps_rows(&f);
        e.goal_x[row] = 26500.0, e.goal_z[row] = 27900.0;
        fixture_run(&f, 1);
        e = steps_rows(&f);
        double to = maths_heading(26500.0 - e.x[row], 27900.0 - e.z[row]);
        beyond = maths_max(beyond, maths_wrap_half(e.heading[row] - to));
    }
    assert_true(beyond < 0.06);
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
        TEST(test_its_circle_is_that_of_a_ship),
        TEST(test_it_stops_within_five_lengths),
        TEST(test_a_ship_runs_on_and_goes_astern),
        TEST(test_an_agent_steers_without_swinging),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
