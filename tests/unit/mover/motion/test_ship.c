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
    return cover_is_water(terrain_cover(&f.view.world.terrain, e.row[row].x, e.row[row].z));
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
        e.row[row[n]].behaviour = e.row[row[n]].order =
            BEHAVIOUR_PATROL; /* the whole world, mostly land */
    }
    for (int frame = 0; frame < (int)(600.0 * HZ); frame++) {
        fixture_run(&f, 1);
        for (uint32_t n = 0; n < 8; n++) {
            assert_true(on_water(row[n]));
            assert_true(steps_rows(&f).row[row[n]].y == FIXTURE_GROUND_M);
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
    double bow = steps_rows(&f).row[row].x + 0.5 * steps_kind(&f, "ship")->length_m;
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
    double bow = steps_rows(&f).row[row].x + 0.5 * steps_kind(&f, "ship")->length_m;
    assert_true(bow < 28000.0 && steps_rows(&f).row[row].vx < -5.0);
}

/* --- aground -----------------------------------------------------------------------------------*/

#define SHORE_M 28062.5 /* half way to the next post */

static bool aground(uint32_t row)
{
    return (steps_rows(&f).row[row].flags & ENTITY_FLAG_AGROUND) != 0;
}

/* Lets a ship of this speed hold its course into the shore. Returns how far its bow slides up. */
static double run_ashore(double speed_mps, uint32_t *row)
{
    const double hardest = 0.7 * GRAVITY_MPS2 + 1e-9;
    steps_empty(&f);
    *row = put_ship(SHORE_M - 100.0, 25010.0, speed_mps);
    double before = speed_mps;
    for (int frame = 0; frame < (int)(30.0 * HZ); frame++) {
        fixture_run(&f, 1);
        assert_true(before - steps_speed(&f, *row) <= hardest / HZ);
        before = steps_speed(&f, *row);
    }
    return steps_rows(&f).row[*row].x + 0.5 * steps_kind(&f, "ship")->length_m - SHORE_M;
}

static void test_a_ship_on_hold_runs_aground(void **state)
{
    static const struct {
        double speed_mps;
        enum damage damage;
    } run[] = {{5.0, DAMAGE_NONE},
               {9.0, DAMAGE_LOW},
               {13.0, DAMAGE_MED},
               {17.5, DAMAGE_HIGH},
               {24.0, DAMAGE_DESTROYED}};
    uint32_t row;
    (void)state;
    for (int n = 0; n < 5; n++) {
        double up_m = run_ashore(run[n].speed_mps, &row);
        double way_m = run[n].speed_mps * run[n].speed_mps / (1.4 * GRAVITY_MPS2);
        print_message("| aground with %4.1f m/s: slides up %4.1f m, damage %d |\n",
                      run[n].speed_mps, up_m, steps_rows(&f).row[row].damage);
        assert_int_equal(steps_rows(&f).row[row].damage, run[n].damage);
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
        const struct event_collision *told = &fixture_event(&f, EVENT_COLLISION, 0)->collision;
        assert_true(told->a.id == row + 1 && told->b.kind == KIND_NONE && told->b.fixed == 1);
        assert_true(fabs(told->point[0] - SHORE_M) < 4.0);
        assert_true(fabs((double)told->closing_mps - run[n].speed_mps) < 0.01);
        if (run[n].damage == DAMAGE_DESTROYED)
            continue;
        assert_true(steps_speed(&f, row) == 0.0 && aground(row));
        assert_true(up_m > way_m - 1.5 && up_m < way_m + 2.5);
        fixture_run(&f, (uint32_t)(60.0 * HZ)); /* it stays */
        assert_true(steps_speed(&f, row) == 0.0 && aground(row));
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    }
}

/* Its screws pull it off if not more than half of it is ashore. */
static void test_a_ship_backs_off_if_it_can(void **state)
{
    static const double ashore_m[2] = {15.0, 30.0};
    const double half = 0.5 * steps_kind(&f, "ship")->length_m;
    (void)state;
    for (int n = 0; n < 2; n++) {
        steps_empty(&f);
        uint32_t row = put_ship(SHORE_M + ashore_m[n] - half, 25010.0, 0.0);
        steps_drive(&f, row, 1.0, 0.5, 0.0); /* ahead it gets nowhere, and does not turn */
        double heading = steps_rows(&f).row[row].heading;
        fixture_run(&f, (uint32_t)(20.0 * HZ));
        assert_true(steps_speed(&f, row) == 0.0 && aground(row));
        assert_true(steps_rows(&f).row[row].heading == heading);
        steps_pedals(&f, row, 1.0, 0.0, GEAR_REVERSE);
        fixture_run(&f, (uint32_t)(60.0 * HZ));
        assert_true(aground(row) == (n == 1));
        assert_true(n == 1 ? steps_speed(&f, row) == 0.0 : steps_rows(&f).row[row].vx < -3.0);
    }
}

/* A headland lies between the ships and where they want to go. It leaves a way in the north. */
static void test_ships_of_agents_sail_around_a_headland(void **state)
{
    uint32_t row[3], there = 0;
    bool arrived[3] = {false, false, false};
    (void)state;
    steps_cover(&f, COVER_GRASS, 24800.0, 24000.0, 25400.0, 28500.0);
    for (uint32_t n = 0; n < 3; n++) {
        row[n] = put_ship(23000.0, 23000.0 + 2000.0 * n, 10.0);
        struct entities e = steps_rows(&f);
        e.row[row[n]].behaviour = e.row[row[n]].order = BEHAVIOUR_PATROL;
    }
    for (int frame = 0; frame < (int)(1500.0 * HZ) && there < 3; frame++) {
        struct entities e = steps_rows(&f);
        for (uint32_t n = 0; n < 3; n++)
            e.row[row[n]].goal_x = 27000.0, e.row[row[n]].goal_z = 25000.0 + 700.0 * n;
        fixture_run(&f, 1);
        e = steps_rows(&f);
        for (uint32_t n = 0; n < 3; n++) {
            assert_false(aground(row[n]));
            there += !arrived[n] && e.row[row[n]].x > 26900.0;
            arrived[n] |= e.row[row[n]].x > 26900.0;
        }
    }
    assert_int_equal(there, 3);
}

static void test_a_ship_of_an_agent_that_is_aground_backs_off(void **state)
{
    uint32_t row = put_ship(SHORE_M - 10.0, 25010.0, 0.0);
    struct entities e = steps_rows(&f);
    (void)state;
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_PATROL;
    e.row[row].goal_x = 26000.0, e.row[row].goal_z = 25010.0;
    fixture_run(&f, 2);
    assert_true(aground(row));
    fixture_run(&f, (uint32_t)(300.0 * HZ));
    assert_false(aground(row));
    assert_true(steps_rows(&f).row[row].x < SHORE_M - 100.0);
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
    assert_true(steps_rows(&f).row[row].pitch == 0.0 && steps_rows(&f).row[row].roll == 0.0);
}

static void test_the_rudder_bites_with_the_ships_way(void **state)
{
    double rate = steps_kind(&f, "ship")->turn_rate_rps;
    double full = steps_kind(&f, "ship")->max_speed_mps;
    uint32_t fast = put_ship(23000.0, 25010.0, full), still = put_ship(23000.0, 26010.0, 0.0);
    (void)state;
    steps_drive(&f, fast, 1.0, 1.0, 0.0);
    steps_drive(&f, still, 0.0, 1.0, 0.0);
    double before[2] = {steps_rows(&f).row[fast].heading, steps_rows(&f).row[still].heading};
    fixture_run(&f, (uint32_t)(5.0 * HZ));
    double turned = maths_wrap_half(steps_rows(&f).row[fast].heading - before[0]);
    assert_true(turned > 2.0 * rate && turned < 3.5 * rate); /* the rudder takes 4 s */
    assert_true(steps_rows(&f).row[fast].roll < -0.03 && steps_rows(&f).row[fast].roll > -0.08);
    turned = maths_wrap_half(steps_rows(&f).row[still].heading - before[1]);
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
    while (fabs(maths_wrap_half(steps_rows(&f).row[row].heading - PI)) > 0.02)
        fixture_run(&f, 1);
    *advance = (steps_rows(&f).row[row].x - 23000.0) / length;
    while (fabs(maths_wrap_half(steps_rows(&f).row[row].heading - 1.5 * PI)) > 0.02)
        fixture_run(&f, 1);
    *diameter = (steps_rows(&f).row[row].z - 25010.0) / length;
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
    tell("crash stop, lengths", 2.0, 5.0, (steps_rows(&f).row[row].x - 23000.0) / kind->length_m);
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
         (steps_rows(&f).row[drifts].x - 23000.0) / kind->length_m);
    assert_true(fabs(steps_rows(&f).row[back].vx + 0.5 * kind->max_speed_mps) < 0.05);
}

static void test_an_agent_steers_without_swinging(void **state)
{
    (void)state;
    uint32_t row = put_ship(23000.0, 25010.0, 10.0);
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_PATROL;
    double beyond = 0.0;
    for (int frame = 0; frame < (int)(120.0 * HZ); frame++) {
        e = steps_rows(&f);
        e.row[row].goal_x = 26500.0, e.row[row].goal_z = 27900.0;
        fixture_run(&f, 1);
        e = steps_rows(&f);
        double to = maths_heading(26500.0 - e.row[row].x, 27900.0 - e.row[row].z);
        beyond = maths_max(beyond, maths_wrap_half(e.row[row].heading - to));
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
        TEST(test_a_ship_on_hold_runs_aground),
        TEST(test_a_ship_backs_off_if_it_can),
        TEST(test_ships_of_agents_sail_around_a_headland),
        TEST(test_a_ship_of_an_agent_that_is_aground_backs_off),
        TEST(test_a_ship_lies_level_and_is_slow_to_gain_speed),
        TEST(test_the_rudder_bites_with_the_ships_way),
        TEST(test_its_circle_is_that_of_a_ship),
        TEST(test_it_stops_within_five_lengths),
        TEST(test_a_ship_runs_on_and_goes_astern),
        TEST(test_an_agent_steers_without_swinging),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
