/* Aeroplanes without thrust: their total energy never rises, they glide, they stall, and they come
 * down. With thrust the energy of an aircraft rises by no more than its engine gives. SEED=n draws
 * other states. */
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define FLIGHTS 120
#define HELD_S  2.0 /* a draw of the stick lasts so long */

static struct fixture f;

static uint32_t put(double height_m, struct vec3 velocity)
{
    steps_empty(&f);
    return fixture_put(
        &f, (struct fixture_entity){.kind = "jet",
                                    .at = {25000.0, FIXTURE_GROUND_M + height_m, 25000.0},
                                    .velocity = velocity,
                                    .heading_rad = HALF_PI,
                                    .behaviour = BEHAVIOUR_IDLE});
}

/* Moves stick and brake of a jet whose engine gives nothing. */
static void fly(uint32_t row, double turn, double climb, double brake)
{
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = BEHAVIOUR_DRIVEN;
    e.row[row].until_tick = UINT32_MAX;
    e.row[row].throttle = 0.0f;
    e.row[row].dodge = 1.0f;
    e.row[row].steer = (float)turn, e.row[row].climb = (float)climb,
    e.row[row].brake = (float)brake;
}

static double energy_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    struct vec3 v = entities_velocity(&e, row);
    return 0.5 * vec3_dot(v, v) + GRAVITY_MPS2 * e.row[row].y;
}

/* Returns the greatest rise of the energy in a frame over half a minute [J/kg]. */
static double hardest_rise(double hz, uint64_t *random)
{
    double speed = fixture_uniform(random, 0.0, 300.0), path = fixture_uniform(random, -1.2, 1.2);
    uint32_t row = put(6000.0, (struct vec3){speed * cos(path), speed * sin(path), 0.0});
    double rise = -1e9;
    for (int frame = 0; frame < (int)(30.0 * hz); frame++) {
        double before = energy_of(row);
        if (frame % (int)(HELD_S * hz) == 0)
            fly(row, fixture_uniform(random, -1.0, 1.0), fixture_uniform(random, -1.0, 1.0),
                fixture_uniform(random, -1.0, 1.0) > 0.5 ? 1.0 : 0.0);
        fixture_run(&f, 1);
        rise = maths_max(rise, energy_of(row) - before);
    }
    return rise;
}

static void test_energy_never_rises_without_thrust(void **state)
{
    static const double rates[] = {60.0, 20.0, 10.0};
    uint64_t random = fixture_seed(11);
    (void)state;
    for (int n = 0; n < 3; n++) {
        char world[64];
        double worst = -1e9;
        fixture_close(&f);
        (void)snprintf(world, sizeof world, "world = { seed = 1; capacity = 64; hz = %.0f; };",
                       rates[n]);
        fixture_open(&f, world);
        for (int flight = 0; flight < FLIGHTS; flight++)
            worst = maths_max(worst, hardest_rise(rates[n], &random));
        print_message("%2.0f Hz: the energy rises by at most %.4f J/kg in a frame\n", rates[n],
                      worst);
        assert_true(worst <= 0.0);
    }
}

/* Without throttle it glides at first, then it sinks at its stalling speed, and it strikes the
 * ground. The ratio is that of way to height. */
static void test_without_throttle_it_glides_stalls_and_comes_down(void **state)
{
    const double hz = 1.0 / f.view.world.params->dt_s, stall = steps_kind(&f, "jet")->min_speed_mps;
    uint32_t row = put(2000.0, (struct vec3){200.0, 0.0, 0.0});
    double slowest = 1e9, lowest_nose = 0.0, begins = 0.0;
    int frame = 0;
    (void)state;
    fly(row, 0.0, 0.0, 0.0);
    for (; frame < (int)(300.0 * hz) && steps_rows(&f).row[row].state == ENTITY_ACTIVE; frame++) {
        struct entities e = steps_rows(&f);
        double speed = vec3_length(entities_velocity(&e, row));
        if (begins == 0.0 && e.row[row].vy < -10.0)
            begins = e.row[row].x;
        slowest = maths_min(slowest, speed);
        lowest_nose = maths_min(lowest_nose, e.row[row].pitch);
        fixture_run(&f, 1);
    }
    struct entities e = steps_rows(&f);
    double ratio = (e.row[row].x - begins) / 2000.0;
    print_message("down after %.0f s; glides 1 : %.1f; slowest %.1f m/s; nose %.0f degrees\n",
                  frame / hz, ratio, slowest, lowest_nose * DEG_PER_RAD);
    assert_true(e.row[row].state != ENTITY_ACTIVE);
    assert_true(ratio > 3.0 && ratio < 6.0);
    assert_true(slowest < stall && slowest > 0.8 * stall);
    assert_true(lowest_nose < -8.0 * RAD_PER_DEG);
}

/* With the stick back it cannot climb for long. */
static void test_pulling_up_without_throttle_gains_no_height_in_the_end(void **state)
{
    const double hz = 1.0 / f.view.world.params->dt_s;
    uint32_t row = put(2000.0, (struct vec3){100.0, 0.0, 0.0});
    double highest = 0.0;
    (void)state;
    fly(row, 0.0, 1.0, 0.0);
    for (int frame = 0; frame < (int)(60.0 * hz); frame++) {
        fixture_run(&f, 1);
        highest = maths_max(highest, steps_rows(&f).row[row].y - FIXTURE_GROUND_M - 2000.0);
    }
    double lost = 2000.0 + FIXTURE_GROUND_M - steps_rows(&f).row[row].y;
    print_message("it rises by %.0f m, then it is %.0f m lower after a minute\n", highest, lost);
    assert_true(highest < 100.0 * 100.0 / (2.0 * GRAVITY_MPS2) && lost > 500.0);
}

/* --- with an engine ----------------------------------------------------------------------------*/

/* Returns the greatest mean power by which the energy rises over three seconds of a flight of half
 * a minute with full throttle [W/kg]. A lean takes a second to follow the stick. */
static double greatest_power(const char *kind, double hz, uint64_t *random)
{
    double speed = fixture_uniform(random, 0.3, 1.0) * steps_kind(&f, kind)->max_speed_mps;
    steps_empty(&f);
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                .at = {25000.0, FIXTURE_GROUND_M + 6000.0, 25000.0},
                                                .velocity = {speed, 0.0, 0.0},
                                                .heading_rad = HALF_PI,
                                                .behaviour = BEHAVIOUR_IDLE});
    double most = 0.0;
    for (int window = 0; window < 10; window++) {
        double before = energy_of(row);
        fly(row, fixture_uniform(random, -1.0, 1.0), fixture_uniform(random, -1.0, 1.0), 0.0);
        steps_rows(&f).row[row].throttle = 1.0f;
        steps_rows(&f).row[row].dodge = 0.0f;
        fixture_run(&f, (uint32_t)(3.0 * hz));
        most = maths_max(most, (energy_of(row) - before) / 3.0);
    }
    return most;
}

/* A jet has the most at 0.61 of its top speed V, where its thrust T and a drag of 0.9 T (v / V)^2
 * leave 0.406 T V. A helicopter has what level flight leaves at the speed of least power, and
 * a little more in a climb, which lessens its inflow. */
static void test_energy_rises_by_no_more_than_the_engine_gives(void **state)
{
    const double hz = 1.0 / f.view.world.params->dt_s;
    const struct kind *jet = steps_kind(&f, "jet"), *helicopter = steps_kind(&f, "helicopter");
    const double limit[2] = {0.406 * jet->acceleration_mps2 * jet->max_speed_mps,
                             0.205 * GRAVITY_MPS2 * helicopter->max_speed_mps};
    uint64_t random = fixture_seed(12);
    (void)state;
    for (int n = 0; n < 2; n++) {
        double most = 0.0;
        for (int flight = 0; flight < FLIGHTS; flight++)
            most = maths_max(most, greatest_power(n ? "helicopter" : "jet", hz, &random));
        print_message("%s: the energy rises by at most %.0f W/kg; its engine gives %.0f\n",
                      n ? "helicopter" : "jet", most, limit[n]);
        assert_true(most < 1.1 * limit[n] && most > 0.5 * limit[n]);
    }
}

int main(void)
{
    fixture_open(&f, "world = { seed = 1; capacity = 64; };");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_without_throttle_it_glides_stalls_and_comes_down),
        cmocka_unit_test(test_pulling_up_without_throttle_gains_no_height_in_the_end),
        cmocka_unit_test(test_energy_rises_by_no_more_than_the_engine_gives),
        cmocka_unit_test(test_energy_never_rises_without_thrust),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    fixture_close(&f);
    return failed;
}
