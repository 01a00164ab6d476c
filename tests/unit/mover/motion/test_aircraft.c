/* Aircraft: height over the ground, least speed, hovering, bank, the world's edge, empty tanks. */
#include "tests/support/steps.h"
#include "world/terrain/gridsquare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ 20.0

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    return 0;
}

/* Ridges across the path east, one every 2 km, 240 m high. */
static double ridges(double x, double z, const void *context)
{
    (void)z, (void)context;
    double along = fabs(x / 2000.0 - floor(x / 2000.0) - 0.5) * 2.0;
    return 100.0 + 240.0 * (1.0 - along);
}

static uint32_t put(const char *kind, double x, double z, double height, double speed_mps,
                    enum behaviour behaviour)
{
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                .at = {x, steps_ground_at(&f, x, z) + height, z},
                                                .velocity = {speed_mps, 0.0, 0.0},
                                                .heading_rad = HALF_PI,
                                                .behaviour = BEHAVIOUR_PATROL});
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = e.row[row].order = (uint8_t)behaviour;
    return row;
}

static double height_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return e.row[row].y - steps_ground_at(&f, e.row[row].x, e.row[row].z);
}

static void test_a_helicopter_keeps_its_height_over_ridges(void **state)
{
    const struct kind *kind = steps_kind(&f, "helicopter");
    uint32_t row;
    double sum = 0.0, least = 1e9;
    int frames = (int)(180.0 * HZ);
    (void)state;
    steps_ground(&f, ridges, NULL);
    row = put("helicopter", 20000.0, 25000.0, kind->cruise_altitude_m, 40.0, BEHAVIOUR_PATROL);
    for (int frame = 0; frame < frames; frame++) {
        struct entities e = steps_rows(&f);
        e.row[row].goal_x = 40000.0; /* on east */
        e.row[row].goal_z = 25000.0;
        fixture_run(&f, 1);
        sum += height_of(row);
        least = maths_min(least, height_of(row));
    }
    assert_true(steps_rows(&f).row[row].x > 27000.0); /* it went over three and more */
    assert_true(least > 10.0 && fabs(sum / frames - kind->cruise_altitude_m) < 40.0);
    assert_int_equal(steps_rows(&f).row[row].state, ENTITY_ACTIVE);
}

static void test_a_helicopter_hovers(void **state)
{
    const struct kind *kind = steps_kind(&f, "helicopter");
    uint32_t row = put("helicopter", 25000.0, 25000.0, 90.0, 40.0, BEHAVIOUR_IDLE);
    (void)state;
    fixture_run(&f, (uint32_t)(40.0 * HZ));
    assert_true(steps_speed(&f, row) < 0.01);
    assert_true(fabs(height_of(row) - kind->cruise_altitude_m) < 0.1);
}

static double airspeed(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return vec3_length(entities_velocity(&e, row));
}

static void test_a_jet_never_stalls_by_its_agent(void **state)
{
    const struct kind *kind = steps_kind(&f, "jet");
    uint32_t idle, patrol;
    (void)state;
    steps_ground(&f, ridges, NULL);
    idle = put("jet", 5000.0, 25000.0, 400.0, kind->min_speed_mps, BEHAVIOUR_IDLE);
    patrol = put("jet", 25000.0, 20000.0, 400.0, 250.0, BEHAVIOUR_PATROL);
    for (int frame = 0; frame < (int)(120.0 * HZ); frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        assert_true(airspeed(idle) > kind->min_speed_mps - 1e-6);
        assert_true(frame < 10 * HZ || airspeed(idle) > 1.25 * kind->min_speed_mps);
        assert_true(airspeed(patrol) > 1.25 * kind->min_speed_mps);
        assert_true(hypot(e.row[patrol].vx, e.row[patrol].vz) < kind->max_speed_mps + 1e-6);
    }
    assert_int_equal(steps_rows(&f).row[idle].state, ENTITY_ACTIVE);
    assert_int_equal(steps_rows(&f).row[patrol].state, ENTITY_ACTIVE);
}

static void test_climbing_stays_within_the_kinds_rate(void **state)
{
    const struct kind *kind = steps_kind(&f, "helicopter");
    uint32_t row = put("helicopter", 25000.0, 25000.0, 200.0, 20.0, BEHAVIOUR_IDLE);
    (void)state;
    for (int frame = 0; frame < (int)(30.0 * HZ); frame++) {
        steps_drive(&f, row, 0.3, 0.0, frame < 300 ? 1.0 : -0.6);
        assert_true(fabs(steps_rows(&f).row[row].vy) <= kind->climb_rate_mps + 1e-9);
        if (frame == 299)
            assert_true(fabs(steps_rows(&f).row[row].vy - kind->climb_rate_mps) < 0.01);
    }
    assert_true(steps_rows(&f).row[row].vy < -5.0);
}

static void test_patrols_stay_inside_the_world(void **state)
{
    uint32_t row[6];
    (void)state;
    for (uint32_t n = 0; n < 6; n++)
        row[n] = put(n % 2 ? "jet" : "helicopter", n < 3 ? 300.0 : 49700.0, 1000.0 + 9000.0 * n,
                     300.0, 70.0, BEHAVIOUR_PATROL);
    for (int frame = 0; frame < (int)(120.0 * HZ); frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        for (uint32_t n = 0; n < 6; n++)
            assert_true(e.row[row[n]].x >= 0.0 && e.row[row[n]].x <= WORLD_SIDE_DEFAULT_M &&
                        e.row[row[n]].z >= 0.0 && e.row[row[n]].z <= WORLD_SIDE_DEFAULT_M);
    }
}

/* The hardest acceleration of a flight towards the edge, gravity included [g]. Fails if the
 * aircraft leaves the world. */
static double turns_back(const char *name, double off_m, double heading, bool driven)
{
    const struct kind *kind = steps_kind(&f, name);
    double speed = 0.9 * kind->max_speed_mps, hardest = 0.0;
    uint32_t row = put(name, 50000.0 - off_m, 25000.0, 900.0, 0.0, BEHAVIOUR_PATROL);
    struct entities e = steps_rows(&f);
    e.row[row].heading = heading;
    e.row[row].vx = speed * sin(heading), e.row[row].vz = -speed * cos(heading);
    if (driven)
        steps_drive(&f, row, 1.0, 0.0, 0.0);
    for (int frame = 0; frame < (int)(40.0 * HZ); frame++) {
        e = steps_rows(&f);
        struct vec3 before = steps_velocity(&f, row);
        e.row[row].goal_x = 60000.0, e.row[row].goal_z = 25000.0; /* its agent wants to go on */
        fixture_run(&f, 1);
        e = steps_rows(&f);
        assert_int_equal(e.row[row].state, ENTITY_ACTIVE);
        struct vec3 felt = vec3_scale(vec3_sub(steps_velocity(&f, row), before), HZ);
        felt.y += GRAVITY_MPS2;
        hardest = maths_max(hardest, vec3_length(felt) / GRAVITY_MPS2);
    }
    steps_empty(&f);
    return hardest;
}

static void test_aircraft_turn_back_before_the_edge(void **state)
{
    static const struct {
        const char *kind;
        double off_m, most;
    } limit[] = {{"jet", 2400.0, 8.0}, {"helicopter", 650.0, 3.5}, {"wishbone", 500.0, 3.5}};
    (void)state;
    for (int n = 0; n < 3; n++) {
        for (int way = 0; way < 10; way++) {
            double load = turns_back(limit[n].kind, limit[n].off_m,
                                     HALF_PI + 0.25 * (double)(way / 2 - 2), way % 2);
            assert_true(load < limit[n].most);
        }
    }
}

static void test_a_helicopter_does_not_fly_backwards_over_the_edge(void **state)
{
    uint32_t row = put("helicopter", 49700.0, 25000.0, 200.0, 0.0, BEHAVIOUR_IDLE);
    (void)state;
    steps_rows(&f).row[row].heading = 1.5 * PI;
    steps_drive(&f, row, -1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(120.0 * HZ));
    assert_int_equal(steps_rows(&f).row[row].state, ENTITY_ACTIVE);
}

/* A jet that is too slow to turn leaves the world without a jump. */
static void test_what_cannot_turn_back_leaves_the_world(void **state)
{
    uint32_t row = put("jet", 49800.0, 25000.0, 900.0, 250.0, BEHAVIOUR_IDLE);
    (void)state;
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    for (double before = 250.0; steps_rows(&f).row[row].state == ENTITY_ACTIVE;) {
        assert_true(fabs(airspeed(row) - before) < 20.0 / HZ);
        before = airspeed(row);
        fixture_run(&f, 1);
    }
    assert_int_equal(
        fixture_event(&f, EVENT_AGENT, fixture_event_count(&f, EVENT_AGENT) - 1)->agent.because,
        REASON_LEFT_WORLD);
}

static void test_it_banks_into_its_turn(void **state)
{
    uint32_t row = put("jet", 25000.0, 25000.0, 900.0, 250.0, BEHAVIOUR_IDLE);
    (void)state;
    steps_drive(&f, row, 1.0, 1.0, 0.0);
    fixture_run(&f, (uint32_t)(3.0 * HZ));
    assert_true(steps_rows(&f).row[row].roll > 1.0 && steps_rows(&f).row[row].roll < HALF_PI);
    steps_drive(&f, row, 1.0, -1.0, 0.0);
    fixture_run(&f, (uint32_t)(3.0 * HZ));
    assert_true(steps_rows(&f).row[row].roll < -1.0);
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(3.0 * HZ));
    assert_true(fabs(steps_rows(&f).row[row].roll) < 1e-6);
}

/* It burns a fifth of full throttle, every ten seconds. */
static void test_a_helicopter_that_hovers_burns_its_fuel_at_times(void **state)
{
    const struct kind *kind = steps_kind(&f, "helicopter");
    uint32_t row =
        put("helicopter", 25000.0, 25000.0, kind->cruise_altitude_m, 0.0, BEHAVIOUR_IDLE);
    uint32_t changes = 0;
    (void)state;
    fixture_run(&f, (uint32_t)HZ);
    double before = steps_rows(&f).row[row].fuel_l;
    for (int frame = 0; frame < 20 * (int)HZ; frame++) {
        double last = steps_rows(&f).row[row].fuel_l;
        fixture_run(&f, 1);
        changes += steps_rows(&f).row[row].fuel_l != last;
    }
    double burnt = before - steps_rows(&f).row[row].fuel_l;
    assert_int_equal(changes, 2);
    assert_true(fabs(burnt - 20.0 * 0.2 * kind->fuel_lps) < 1e-9);
}

static void test_without_fuel_it_comes_down(void **state)
{
    uint32_t row = put("helicopter", 25000.0, 25000.0, 200.0, 20.0, BEHAVIOUR_PATROL);
    (void)state;
    steps_rows(&f).row[row].fuel_l = 0.0;
    fixture_run(&f, (uint32_t)(5.0 * HZ));
    assert_true(steps_rows(&f).row[row].vy == -steps_kind(&f, "helicopter")->climb_rate_mps);
    fixture_run(&f, (uint32_t)(20.0 * HZ));
    /* It lies on its belly, its middle half of its height over the ground. */
    double half = 0.5 * steps_kind(&f, "helicopter")->height_m;
    assert_true(fabs(steps_rows(&f).row[row].y - FIXTURE_GROUND_M - half) < 0.1);
}

static void test_a_driven_helicopter_follows_stick_and_collective(void **state)
{
    const struct kind *kind = steps_kind(&f, "helicopter");
    uint32_t row = put("helicopter", 25000.0, 25000.0, 200.0, 0.0, BEHAVIOUR_IDLE);
    (void)state;
    steps_drive(&f, row, -1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(10.0 * HZ));
    assert_true(fabs(steps_rows(&f).row[row].vx + 0.25 * kind->max_speed_mps) < 1e-9);
    assert_true(steps_rows(&f).row[row].pitch > 0.0); /* it leans back */
    double height = steps_rows(&f).row[row].y;
    steps_drive(&f, row, 0.0, 1.0, 0.0); /* comes to a hover and turns there */
    fixture_run(&f, (uint32_t)(10.0 * HZ));
    assert_true(steps_speed(&f, row) < 1e-9 && steps_rows(&f).row[row].y == height);
    double heading = steps_rows(&f).row[row].heading;
    fixture_run(&f, (uint32_t)HZ);
    assert_true(fabs(maths_wrap_half(steps_rows(&f).row[row].heading - heading) -
                     kind->turn_rate_rps) < 1e-9);
    steps_drive(&f, row, 0.0, 0.0, 0.5);
    fixture_run(&f, (uint32_t)(5.0 * HZ));
    assert_true(fabs(steps_rows(&f).row[row].vy - 0.5 * kind->climb_rate_mps) < 1e-9);
}

static void test_a_jets_throttle_is_above_its_least_speed_and_its_brake_slows_it(void **state)
{
    const struct kind *kind = steps_kind(&f, "jet");
    uint32_t row = put("jet", 25000.0, 25000.0, 900.0, 200.0, BEHAVIOUR_IDLE);
    (void)state;
    steps_pedals(&f, row, 1.0, 1.0, GEAR_AUTOMATIC);
    double before = steps_speed(&f, row);
    fixture_run(&f, (uint32_t)HZ);
    /* The brakes are as strong as the engine, and drag helps them. */
    double slowed = before - steps_speed(&f, row);
    assert_true(slowed > kind->acceleration_mps2 && slowed < 2.0 * kind->acceleration_mps2);
    static const double throttle[2] = {0.1, 0.5};
    for (int n = 0; n < 2; n++) {
        double faster = throttle[n] * (kind->max_speed_mps - kind->min_speed_mps);
        steps_drive(&f, row, throttle[n], 0.0, 0.0);
        fixture_run(&f, (uint32_t)(60.0 * HZ));
        assert_true(fabs(steps_speed(&f, row) - kind->min_speed_mps - faster) < 1e-6);
        assert_true(fabs(steps_rows(&f).row[row].vy) < 1e-6);
    }
}

static void test_nothing_is_nan_with_a_kind_that_cannot_fly(void **state)
{
    struct kind *kind = steps_kind(&f, "helicopter");
    uint32_t row = put("helicopter", 25000.0, 25000.0, 200.0, 0.0, BEHAVIOUR_IDLE);
    (void)state;
    kind->max_speed_mps = 0.0; /* config/ allows it */
    fixture_run(&f, 10);
    struct entities e = steps_rows(&f);
    assert_true(isfinite(e.row[row].x) && isfinite(e.row[row].y) && isfinite(e.row[row].pitch) &&
                isfinite(e.row[row].fuel_l));
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_helicopter_keeps_its_height_over_ridges),
        TEST(test_a_helicopter_hovers),
        TEST(test_a_jet_never_stalls_by_its_agent),
        TEST(test_climbing_stays_within_the_kinds_rate),
        TEST(test_patrols_stay_inside_the_world),
        TEST(test_aircraft_turn_back_before_the_edge),
        TEST(test_a_helicopter_does_not_fly_backwards_over_the_edge),
        TEST(test_what_cannot_turn_back_leaves_the_world),
        TEST(test_it_banks_into_its_turn),
        TEST(test_a_helicopter_that_hovers_burns_its_fuel_at_times),
        TEST(test_without_fuel_it_comes_down),
        TEST(test_a_driven_helicopter_follows_stick_and_collective),
        TEST(test_a_jets_throttle_is_above_its_least_speed_and_its_brake_slows_it),
        TEST(test_nothing_is_nan_with_a_kind_that_cannot_fly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
