/* Flight: load, bank and rate of turn, stall, climb, tilt, hover. It prints a table of what is real
 * and what is ours. */
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

static struct fixture f;
static double hz;

static void open_at(double rate)
{
    char world[64];
    hz = rate;
    (void)snprintf(world, sizeof world, "world = { seed = 1; capacity = 64; hz = %.1f; };", rate);
    fixture_open(&f, world);
}

static int open_world(void **state)
{
    (void)state;
    open_at(60.0);
    return 0;
}

static uint32_t put(const char *kind, double height, double speed_mps, enum behaviour behaviour)
{
    return fixture_put(&f,
                       (struct fixture_entity){.kind = kind,
                                               .at = {25000.0, FIXTURE_GROUND_M + height, 25000.0},
                                               .velocity = {speed_mps, 0.0, 0.0},
                                               .heading_rad = HALF_PI,
                                               .behaviour = behaviour});
}

static struct vec3 velocity_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return entities_velocity(&e, row);
}

static void seconds(double s)
{
    fixture_run(&f, (uint32_t)(s * hz + 0.5));
}

static void tell(const char *what, double real, double ours, double tolerance)
{
    print_message("| %-40s | %8.2f | %8.2f | %5.0f %% |\n", what, real, ours, 100.0 * tolerance);
    assert_true(fabs(ours / real - 1.0) <= tolerance);
}

/* The load [g] in a frame: what the crew feels. */
static double load_in_a_frame(uint32_t row)
{
    struct vec3 before = velocity_of(row);
    fixture_run(&f, 1);
    struct vec3 felt = vec3_scale(vec3_sub(velocity_of(row), before), hz);
    felt.y += GRAVITY_MPS2;
    return vec3_length(felt) / GRAVITY_MPS2;
}

/* Full deflections at random for a minute. Returns the hardest load. */
static double hardest_load(uint32_t row, uint64_t seed)
{
    uint64_t random = fixture_seed(seed);
    double hardest = 0.0;
    for (int n = 0; n < 40; n++) {
        double turn = fixture_uniform(&random, -1.6, 1.6), up = fixture_uniform(&random, -1.6, 1.6);
        steps_drive(&f, row, fixture_uniform(&random, 0.3, 1.0), maths_clamp(turn, -1.0, 1.0),
                    maths_clamp(up, -1.0, 1.0));
        for (int frame = 0; frame < (int)(1.5 * hz); frame++)
            hardest = maths_max(hardest, load_in_a_frame(row));
        steps_rows(&f).row[row].y = FIXTURE_GROUND_M + 3000.0; /* it never strikes the ground */
    }
    return hardest;
}

static void test_loads_stay_within_what_airframes_bear(void **state)
{
    static const struct {
        const char *kind;
        double most;
    } limit[] = {{"jet", 8.0}, {"helicopter", 3.5}, {"wishbone", 3.5}, {"helo-cow", 3.5}};
    (void)state;
    for (size_t n = 0; n < sizeof limit / sizeof limit[0]; n++) {
        uint32_t row = put(limit[n].kind, 3000.0, steps_kind(&f, limit[n].kind)->max_speed_mps,
                           BEHAVIOUR_IDLE);
        double load = hardest_load(row, 3 + n);
        print_message("| load of a %-30s | <= %5.1f | %8.2f |    hard |\n", limit[n].kind,
                      limit[n].most, load);
        assert_true(load <= limit[n].most && load > 1.3);
        steps_empty(&f);
    }
}

/* Turns at full deflection until the bank stands, and returns the rate of turn [rad/s] over half a
 * second. speed, bank: in its middle. */
static double turn_hard(uint32_t row, double lead_s, double *speed, double *bank)
{
    seconds(lead_s);
    double before = steps_rows(&f).row[row].heading;
    seconds(0.25);
    *speed = vec3_length(velocity_of(row)), *bank = fabs(steps_rows(&f).row[row].roll);
    seconds(0.25);
    return fabs(maths_wrap_half(steps_rows(&f).row[row].heading - before)) / 0.5;
}

static void test_a_turn_follows_from_the_load(void **state)
{
    double speed, bank, rate;
    (void)state;
    steps_kind(&f, "jet")->max_load = 6.0;
    uint32_t jet = put("jet", 3000.0, 277.8, BEHAVIOUR_IDLE);
    steps_drive(&f, jet, 1.0, 1.0, 0.0);
    rate = turn_hard(jet, 1.0, &speed, &bank);
    tell("jet, 6 g at 278 m/s: bank, degrees", 80.4, bank * DEG_PER_RAD, 0.01);
    tell("  degrees/s, if it kept its speed", 12.0, rate * DEG_PER_RAD * speed / 277.8, 0.02);
    tell("  radius m, if it kept its speed", 1330.0, speed / rate * 277.8 * 277.8 / speed / speed,
         0.02);
    steps_empty(&f);
    uint32_t helicopter = put("helicopter", 300.0, 60.0, BEHAVIOUR_IDLE);
    steps_drive(&f, helicopter, 0.8, 1.0, 0.0);
    rate = turn_hard(helicopter, 3.0, &speed, &bank);
    tell("helicopter, 2 g at 60 m/s: bank", 60.0, bank * DEG_PER_RAD, 0.01);
    tell("  degrees/s, if it kept its speed", 16.2, rate * DEG_PER_RAD * speed / 60.0, 0.03);
    tell("  radius m, if it kept its speed", 212.0, speed / rate * 3600.0 / speed / speed, 0.03);
}

static void test_a_hard_turn_costs_speed(void **state)
{
    (void)state;
    uint32_t jet = put("jet", 3000.0, 277.8, BEHAVIOUR_IDLE);
    steps_drive(&f, jet, 1.0, 1.0, 0.0);
    seconds(30.0);
    double speed = vec3_length(velocity_of(jet));
    print_message("full deflection for 30 s: 278 to %.0f m/s\n", speed);
    assert_true(speed < 210.0 && speed > steps_kind(&f, "jet")->min_speed_mps);
    steps_drive(&f, jet, 1.0, 0.0, 0.0);
    seconds(60.0);
    assert_true(vec3_length(velocity_of(jet)) > 270.0);
}

/* The load [g] across the path of an aeroplane in a frame, which its wings must give. */
static double lift_in_a_frame(uint32_t row)
{
    struct vec3 before = velocity_of(row);
    fixture_run(&f, 1);
    struct vec3 after = velocity_of(row), felt = vec3_scale(vec3_sub(after, before), hz);
    felt.y += GRAVITY_MPS2;
    struct vec3 path = vec3_add(before, after);
    path = vec3_scale(path, 1.0 / vec3_length(path));
    felt = vec3_sub(felt, vec3_scale(path, vec3_dot(felt, path)));
    return vec3_length(felt) / GRAVITY_MPS2;
}

/* The stick pulled or turned at any speed, level, banked or in a steep climb: the lift is never
 * more than the square of the speed over the stalling speed. */
static void test_lift_follows_from_the_speed(void **state)
{
    static const double throttle[] = {0.0, 0.3, 1.0}, turn[] = {0.0, -1.0, 0.6};
    (void)state;
    double stall = steps_kind(&f, "jet")->min_speed_mps, worst = 0.0;
    for (uint32_t n = 0; n < 27; n++) {
        steps_empty(&f);
        uint32_t jet = put("jet", 3000.0, n < 9 ? 80.0 : n < 18 ? 110.0 : 200.0, BEHAVIOUR_IDLE);
        steps_drive(&f, jet, throttle[n % 3], turn[n / 3 % 3], 1.0);
        for (int frame = 0; frame < (int)(60.0 * hz); frame++) {
            double before = vec3_length(velocity_of(jet)), lift = lift_in_a_frame(jet);
            double share = maths_max(before, vec3_length(velocity_of(jet))) / stall;
            worst = maths_max(worst, lift - share * share);
        }
    }
    print_message("lift over that of the speed: %.3f g\n", worst);
    /* A path is never steeper than 76 degrees, so one that has stalled and falls is held by so
     * much. */
    assert_true(worst < 0.15);
}

static void test_below_its_stalling_speed_an_aeroplane_falls_until_it_is_faster(void **state)
{
    (void)state;
    uint32_t jet = put("jet", 3000.0, 80.0, BEHAVIOUR_IDLE);
    steps_drive(&f, jet, 0.0, 0.0, 1.0);
    struct entities e = steps_rows(&f);
    e.row[jet].brake = 1.0f;
    double stall = steps_kind(&f, "jet")->min_speed_mps, slowest = 1e9, lowest = 0.0;
    for (int frame = 0; frame < (int)(20.0 * hz); frame++) {
        fixture_run(&f, 1);
        slowest = maths_min(slowest, vec3_length(velocity_of(jet)));
        lowest = maths_min(lowest, steps_rows(&f).row[jet].pitch);
    }
    assert_true(slowest < stall && lowest < -0.1 && velocity_of(jet).y < -3.0);
    steps_drive(&f, jet, 1.0, 0.0, 0.0);
    seconds(20.0);
    assert_true(vec3_length(velocity_of(jet)) > 1.3 * stall && fabs(velocity_of(jet).y) < 0.1);
}

static void test_thrust_limits_the_climb(void **state)
{
    (void)state;
    uint32_t jet = put("jet", 1000.0, 200.0, BEHAVIOUR_IDLE);
    uint32_t helicopter = put("helicopter", 1500.0, 40.0, BEHAVIOUR_IDLE);
    steps_drive(&f, jet, 1.0, 0.0, 1.0);
    steps_drive(&f, helicopter, 0.5, 0.0, 1.0);
    seconds(60.0);
    struct vec3 v = velocity_of(jet);
    print_message("jet climbs with %.0f m/s at %.0f m/s\n", v.y, vec3_length(v));
    tell("jet, steady climb m/s", 80.0, v.y, 0.05);
    assert_true(vec3_length(v) > 100.0);
    tell("helicopter, climb m/s", 12.0, velocity_of(helicopter).y, 0.01);
}

/* --- power -------------------------------------------------------------------------------------*/

/* A flight with controls that stay as they are: what it comes to. */
struct steady {
    double speed_mps, climb_mps, load;
};

static struct steady fly_steadily(const char *kind, double speed_mps, double turn, double climb,
                                  double time_s)
{
    uint32_t row = put(kind, 2000.0, speed_mps, BEHAVIOUR_IDLE);
    steps_drive(&f, row, 1.0, turn, climb);
    seconds(time_s);
    struct steady found = {0};
    for (int frame = 0; frame < (int)hz; frame++) {
        found.load += load_in_a_frame(row) / hz;
        found.climb_mps += velocity_of(row).y / hz;
        found.speed_mps += vec3_length(velocity_of(row)) / hz;
    }
    print_message("%s, turn %.0f, climb %.0f, after %3.0f s: %5.1f m/s, climbs %5.1f m/s, %.2f g\n",
                  kind, turn, climb, time_s, found.speed_mps, found.climb_mps, found.load);
    steps_empty(&f);
    return found;
}

static void test_a_helicopter_pays_for_turns_and_climbs_with_speed(void **state)
{
    (void)state;
    struct steady level = fly_steadily("helicopter", 60.0, 0.0, 0.0, 60.0);
    struct steady climbs = fly_steadily("helicopter", 75.0, 0.0, 1.0, 60.0);
    struct steady enters = fly_steadily("helicopter", 75.0, 1.0, 0.0, 5.0);
    struct steady turns = fly_steadily("helicopter", 75.0, 1.0, 0.0, 60.0);
    struct steady both = fly_steadily("helicopter", 75.0, 1.0, 1.0, 60.0);
    struct steady rises = fly_steadily("helicopter", 0.0, 0.0, 1.0, 20.0);
    assert_true(fabs(level.speed_mps - 75.0) < 0.1);
    assert_true(climbs.climb_mps > 11.5 && climbs.speed_mps < 60.0 && climbs.speed_mps > 40.0);
    assert_true(enters.load > 1.9 && enters.speed_mps < 72.0);
    tell("helicopter, load that it sustains, g", 1.75, turns.load, 0.1); /* 1.6 to 1.9 */
    assert_true(turns.speed_mps < 45.0 && turns.speed_mps > 25.0 && fabs(turns.climb_mps) < 1.0);
    assert_true(both.climb_mps < 4.0 && both.speed_mps < 45.0);
    assert_true(rises.climb_mps > 8.0 && rises.speed_mps < 30.0);
}

/* An agent that has to turn back and to rise by 35 m rises first. */
static void test_an_agent_climbs_before_it_banks(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 10.0, 45.0, BEHAVIOUR_PATROL);
    steps_rows(&f).row[row].goal_x = 15000.0, steps_rows(&f).row[row].goal_z = 25000.0;
    seconds(2.5);
    print_message("in a turn of %.0f degrees of bank an agent climbs %.1f m/s\n",
                  fabs(steps_rows(&f).row[row].roll) * DEG_PER_RAD, velocity_of(row).y);
    assert_true(velocity_of(row).y > 8.0 && fabs(steps_rows(&f).row[row].roll) > 0.1);
}

/* One that is slow, and in the steepest turn that its engine bears, rolls out of it to climb. */
static void test_an_agent_rolls_out_to_climb(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 15.0, 23.0, BEHAVIOUR_PATROL);
    struct entities e = steps_rows(&f);
    e.row[row].roll = 0.95f;
    for (int frame = 0; frame < (int)(3.0 * hz); frame++) {
        e = steps_rows(&f);
        e.row[row].goal_x = e.row[row].x + 5000.0 * maths_sin(e.row[row].heading + 2.5);
        e.row[row].goal_z = e.row[row].z - 5000.0 * maths_cos(e.row[row].heading + 2.5);
        fixture_run(&f, 1);
    }
    print_message("from 54 degrees of bank, after 3 s: %.0f degrees, climbs %.1f m/s\n",
                  fabs(steps_rows(&f).row[row].roll) * DEG_PER_RAD, velocity_of(row).y);
    assert_true(velocity_of(row).y > 8.0);
}

/* A jet turns harder than it can go on turning. */
static void test_a_jet_sustains_less_than_it_pulls(void **state)
{
    (void)state;
    struct steady pulls = fly_steadily("jet", 277.8, 1.0, 0.0, 1.0);
    struct steady holds = fly_steadily("jet", 220.0, 1.0, 0.0, 90.0);
    assert_true(pulls.load > 6.5 && pulls.speed_mps < 275.0);
    assert_true(holds.load > 2.8 && holds.load < 4.5 && holds.speed_mps < 150.0);
}

static void test_without_fuel_an_aeroplane_glides(void **state)
{
    (void)state;
    uint32_t jet = put("jet", 3000.0, 200.0, BEHAVIOUR_PATROL);
    steps_rows(&f).row[jet].fuel_l = 0.0;
    for (int s = 0; s < 60; s++) {
        seconds(1.0);
        assert_true(vec3_length(velocity_of(jet)) > steps_kind(&f, "jet")->min_speed_mps);
    }
    double sink = -velocity_of(jet).y, ratio = vec3_length(velocity_of(jet)) / sink;
    print_message("it glides 1 : %.1f, sinks with %.0f m/s\n", ratio, sink);
    assert_true(ratio > 3.0 && ratio < 8.0);
}

static void test_a_helicopter_leans_before_it_gains_speed(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 300.0, 0.0, BEHAVIOUR_IDLE);
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    double tilt = 0.0;
    for (int frame = 0; frame < (int)(60.0 * hz); frame++) {
        double before = velocity_of(row).x;
        fixture_run(&f, 1);
        if (frame == (int)(3.0 * hz))
            tell("helicopter, acceleration over g tan(tilt)", 1.0,
                 (velocity_of(row).x - before) * hz / GRAVITY_MPS2 /
                     tan(-steps_rows(&f).row[row].pitch),
                 0.05);
        tilt = maths_max(tilt, -steps_rows(&f).row[row].pitch);
    }
    print_message("helicopter, tilt %.2f degrees\n", tilt * DEG_PER_RAD);
    assert_true(tilt <= 30.0 * RAD_PER_DEG + 1e-9 && tilt > 20.0 * RAD_PER_DEG);
    assert_true(fabs(velocity_of(row).x - steps_kind(&f, "helicopter")->max_speed_mps) < 0.01);
    assert_true(steps_rows(&f).row[row].pitch < -8.0 * RAD_PER_DEG);
    steps_drive(&f, row, 0.0, 0.0, 0.0);
    seconds(1.0);
    assert_true(steps_rows(&f).row[row].pitch > 5.0 * RAD_PER_DEG); /* it flares */
    seconds(39.0);
    assert_true(steps_speed(&f, row) == 0.0 && fabs(steps_rows(&f).row[row].pitch) < 1e-6);
}

/* Where a jet and a helicopter are after the same flight at another rate. */
static void fly_course(double rate, struct vec3 at[2])
{
    fixture_close(&f);
    open_at(rate);
    uint32_t row[2] = {put("jet", 1000.0, 200.0, BEHAVIOUR_IDLE),
                       put("helicopter", 300.0, 40.0, BEHAVIOUR_IDLE)};
    static const double course[][3] = {{1.0, 0.6, 0.5}, {0.6, -1.0, 0.0}, {0.9, 0.0, -0.3}};
    for (int leg = 0; leg < 3; leg++) {
        for (int n = 0; n < 2; n++) {
            struct entities e = steps_rows(&f);
            e.row[row[n]].behaviour = BEHAVIOUR_DRIVEN;
            e.row[row[n]].until_tick = UINT32_MAX;
            e.row[row[n]].throttle = (float)course[leg][0];
            e.row[row[n]].steer = (float)course[leg][1];
            e.row[row[n]].climb = (float)course[leg][2];
        }
        seconds(6.0);
    }
    struct entities e = steps_rows(&f);
    for (int n = 0; n < 2; n++)
        at[n] = entities_position(&e, row[n]);
}

/* --- engines -----------------------------------------------------------------------------------*/

static double spool(uint32_t row)
{
    return 1.0 - (double)steps_rows(&f).row[row].dodge;
}

/* Waits until the engine gives this share of its power, and returns the time [s]. */
static double time_to(uint32_t row, double share)
{
    double s = 0.0;
    for (; spool(row) < share && s < 20.0; s += 1.0 / hz)
        fixture_run(&f, 1);
    return s;
}

static double forward_mps2(uint32_t row)
{
    double before = vec3_length(velocity_of(row));
    seconds(0.1);
    return (vec3_length(velocity_of(row)) - before) / 0.1;
}

static void test_a_jet_engine_takes_five_seconds_to_full_thrust(void **state)
{
    (void)state;
    for (int rate = 0; rate < 2; rate++) {
        fixture_close(&f);
        open_at(rate ? 10.0 : 60.0);
        uint32_t row = put("jet", 3000.0, 270.0, BEHAVIOUR_IDLE);
        steps_drive(&f, row, 0.0, 0.0, 0.0);
        seconds(4.0);
        assert_true(spool(row) < 0.01 && vec3_length(velocity_of(row)) < 265.0);
        steps_drive(&f, row, 1.0, 0.0, 0.0);
        double slow = forward_mps2(row);
        tell("jet, idle to 95 % thrust, s", 5.0, time_to(row, 0.95), 0.1);
        double fast = forward_mps2(row);
        print_message("| %-40s |          | %8.2f |         |\n", "  acceleration at first, m/s2",
                      slow);
        print_message("| %-40s |          | %8.2f |         |\n", "  and with that thrust", fast);
        assert_true(slow < 0.0 && fast > slow + 3.0);
    }
}

static void test_a_governor_takes_a_second_or_two(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 300.0, 0.0, BEHAVIOUR_IDLE);
    steps_drive(&f, row, 0.0, 0.0, 0.0);
    seconds(3.0);
    tell("helicopter, power at a hover, of the full", 0.625, spool(row), 0.02);
    steps_drive(&f, row, 0.0, 0.0, -1.0);
    double s = 0.0, low = 1.0;
    for (; s < 0.7; s += 1.0 / hz) {
        fixture_run(&f, 1);
        low = maths_min(low, spool(row));
    }
    steps_drive(&f, row, 0.0, 0.0, 1.0);
    double rise_s = time_to(row, 0.98);
    print_message("| %-40s |          | %8.2f |         |\n", "  lowest when it goes down", low);
    tell("  seconds from idle to full, 1 to 2", 1.5, rise_s / (0.98 - low), 0.1);
}

/* Agents' engines have no lag, and a driver takes over an engine that runs. */
static void test_a_driver_takes_over_an_engine_that_runs(void **state)
{
    (void)state;
    uint32_t row = put("jet", 3000.0, 200.0, BEHAVIOUR_IDLE);
    steps_rows(&f).row[row].dodge = 0.4f; /* its agent goes around something */
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    seconds(0.1);
    assert_true(spool(row) > 0.95);
}

static void test_10_and_60_hz_agree(void **state)
{
    static const double way[2] = {3600.0, 900.0};
    struct vec3 slow[2], fast[2];
    (void)state;
    fly_course(10.0, slow);
    fly_course(60.0, fast);
    for (int n = 0; n < 2; n++) {
        double off = vec3_length(vec3_sub(slow[n], fast[n])) / way[n];
        print_message("%s: 10 and 60 Hz are %.1f %% of the way apart\n", n ? "helicopter" : "jet",
                      100.0 * off);
        assert_true(off < 0.05);
    }
}

static uint64_t digest_on(uint32_t threads)
{
    fixture_close(&f);
    open_at(20.0);
    fixture_threads(&f, threads);
    for (uint32_t n = 0; n < 40; n++) {
        uint32_t row = put(n % 2 ? "jet" : "helicopter", 200.0 + 20.0 * n, 90.0, BEHAVIOUR_PATROL);
        struct entities e = steps_rows(&f);
        e.row[row].z += 300.0 * n;
        e.row[row].goal_x = 10000.0 + 700.0 * n, e.row[row].goal_z = 30000.0 - 300.0 * n;
    }
    seconds(30.0);
    return fixture_digest(&f);
}

static void test_the_digest_does_not_depend_on_threads(void **state)
{
    (void)state;
    uint64_t one = digest_on(1);
    assert_true(digest_on(2) == one && digest_on(4) == one);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_loads_stay_within_what_airframes_bear),
        TEST(test_a_turn_follows_from_the_load),
        TEST(test_a_hard_turn_costs_speed),
        TEST(test_lift_follows_from_the_speed),
        TEST(test_below_its_stalling_speed_an_aeroplane_falls_until_it_is_faster),
        TEST(test_thrust_limits_the_climb),
        TEST(test_a_helicopter_pays_for_turns_and_climbs_with_speed),
        TEST(test_an_agent_climbs_before_it_banks),
        TEST(test_an_agent_rolls_out_to_climb),
        TEST(test_a_jet_sustains_less_than_it_pulls),
        TEST(test_without_fuel_an_aeroplane_glides),
        TEST(test_a_helicopter_leans_before_it_gains_speed),
        TEST(test_a_jet_engine_takes_five_seconds_to_full_thrust),
        TEST(test_a_governor_takes_a_second_or_two),
        TEST(test_a_driver_takes_over_an_engine_that_runs),
        TEST(test_10_and_60_hz_agree),
        TEST(test_the_digest_does_not_depend_on_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
