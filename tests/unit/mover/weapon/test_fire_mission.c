/* Fire missions: rates of fire, errors, observers, batteries off the map, fuzes and bombs. */
#include "mover/weapon/fire_mission.h"

#include "mover/weapon/fire.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define GROUND_M FIXTURE_GROUND_M

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 2048; };");
    return 0;
}

static void reopen(const char *text)
{
    fixture_close(&f);
    fixture_open(&f, text);
}

static uint32_t put(const char *kind, double x, double z, enum force force)
{
    return fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                   .at = {x, GROUND_M, z},
                                                   .heading_rad = HALF_PI,
                                                   .force = force,
                                                   .behaviour = BEHAVIOUR_IDLE});
}

static void expect(const char *what, double low, double high, double ours)
{
    print_message("%-44s %9.4g to %-9.4g %10.4g\n", what, low, high, ours);
    if (!(ours >= low && ours <= high))
        fail_msg("%s: %g", what, ours);
}

/* Begins a mission in the middle of a frame, and commits it. */
static bool begin(const struct fire_mission_order *order)
{
    struct step_context step;
    struct serial_context context;
    steps_serial_context(&f, &step, &context);
    bool begun = fire_mission_begin(&context, order);
    struct state now = fixture_state(&f);
    now.head->battery_count = f.view.m.head->battery_count;
    for (uint32_t i = 0; i < BATTERIES_MAX; i++)
        now.head->battery[i] = f.view.m.head->battery[i];
    return begun;
}

static int by_value(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

/* Half of the values are within the probable error of their mean. */
static double probable_error(double *value, int count)
{
    double mean = 0.0;
    for (int i = 0; i < count; i++)
        mean += value[i] / count;
    for (int i = 0; i < count; i++)
        value[i] = fabs(value[i] - mean);
    qsort(value, (size_t)count, sizeof *value, by_value);
    return value[count / 2];
}

static void test_probable_errors_of_200_rounds(void **state)
{
    enum { ROUNDS = 200 };
    static double far[ROUNDS], aside[ROUNDS];
    struct step_context step;
    struct serial_context context;
    struct firing_arc_solution solution;
    struct fire_error error;
    (void)state;
    for (int high = 0; high < 2; high++) {
        reopen("world = { seed = 1; capacity = 2048; };");
        uint32_t gun = put("howitzer", 15000.0, 25000.0, FORCE_BLUE);
        steps_kind(&f, "howitzer")->rounds = 1000;
        steps_rows(&f).row[gun].rounds = 1000;
        steps_serial_context(&f, &step, &context);
        struct vec3 muzzle = {15000.0, GROUND_M, 25000.0}, point = {25000.0, GROUND_M, 25000.0};
        uint16_t munition = fixture_kind(&f, "artillery");
        assert_true(fire_solve(&step, muzzle, munition, point, high, &solution));
        const struct fire_shell shell = {.solution = &solution, .munition = munition};
        for (int n = 0; n < ROUNDS; n++) {
            assert_true(fire_shell(&context, gun, &shell, &error));
            struct vec3 at = entities_position(&f.view.m.entities, (uint32_t)(1 + n));
            struct vec3 velocity = entities_velocity(&f.view.m.entities, (uint32_t)(1 + n));
            firing_arc_fall(steps_kind(&f, "artillery"), step.wind, GROUND_M, &at, &velocity);
            far[n] = at.x, aside[n] = at.z;
        }
        expect(high ? "high: PE in range, % of 10 km" : "low: PE in range, % of 10 km", 0.3, 0.5,
               probable_error(far, ROUNDS) / 100.0);
        expect("  PE in deflection, %", 0.05, 0.1, probable_error(aside, ROUNDS) / 100.0);
    }
}

static void test_a_gun_fires_four_a_minute_for_three_minutes_and_then_one(void **state)
{
    uint32_t gun = put("howitzer", 15000.0, 25000.0, FORCE_BLUE), counts[7] = {0};
    (void)state;
    steps_rows(&f).row[gun].gun = 0.3f;
    assert_true(begin(&(struct fire_mission_order){.x = 25000.0,
                                                   .z = 25000.0,
                                                   .gun = gun,
                                                   .rounds = 16,
                                                   .munition = KIND_NONE,
                                                   .fuze = FUZE_COUNT}));
    fixture_run(&f, 60 * (60 * 7 + 30));
    uint32_t shots = fixture_event_count(&f, EVENT_FIRE);
    assert_int_equal(shots, 16);
    uint64_t first = fixture_event(&f, EVENT_FIRE, 0)->tick;
    for (uint32_t n = 0; n < shots; n++)
        counts[(fixture_event(&f, EVENT_FIRE, n)->tick - first) / 3600]++;
    for (int minute = 0; minute < 7; minute++)
        expect("rounds in a minute",
               minute < 3    ? 4
               : minute == 6 ? 0
                             : 1,
               minute < 3    ? 4
               : minute == 6 ? 2
                             : 1,
               counts[minute]);
    assert_int_equal(steps_rows(&f).row[gun].rounds, 36 - 16);
    assert_int_equal(fixture_event_count(&f, EVENT_DETONATION), 16);
    assert_int_equal(fixture_state(&f).head->battery[0].phase, BATTERY_DONE);
}

/* Runs until the battery's mission is over and its rounds have fallen. Returns the mean distance on
 * the map of the detonations from n on to the target, and that of their mean. */
static double mean_miss(uint32_t from, double x, double z)
{
    double sum_x = 0.0, sum_z = 0.0;
    uint32_t count = fixture_event_count(&f, EVENT_DETONATION);
    assert_true(count > from);
    for (uint32_t n = from; n < count; n++) {
        const double *point = fixture_event(&f, EVENT_DETONATION, n)->detonation.point;
        sum_x += point[0] - x;
        sum_z += point[2] - z;
    }
    return sqrt(sum_x * sum_x + sum_z * sum_z) / (count - from);
}

static void test_an_observer_brings_the_fire_to_the_target(void **state)
{
    double before = 0.0, after = 0.0, rounds = 0.0;
    enum { MISSIONS = 12 };
    (void)state;
    for (int n = 0; n < MISSIONS; n++) {
        char text[64];
        (void)snprintf(text, sizeof text, "world = { seed = %d; capacity = 128; };", n + 1);
        reopen(text);
        uint32_t gun = put("howitzer", 17000.0, 25000.0, FORCE_BLUE);
        for (int other = 1; other < 6; other++)
            put("howitzer", 17000.0, 25000.0 + 40.0 * other, FORCE_BLUE);
        put("jeep", 24000.0, 25000.0, FORCE_BLUE);
        assert_true(begin(&(struct fire_mission_order){.x = 25000.0,
                                                       .z = 25000.0,
                                                       .gun = gun,
                                                       .rounds = 12,
                                                       .munition = KIND_NONE,
                                                       .fuze = FUZE_COUNT,
                                                       .adjusted = true}));
        fixture_run(&f, 60 * 60 * 9);
        uint32_t all = fixture_event_count(&f, EVENT_DETONATION);
        assert_true(all >= 12 + 2 && all <= 12 + 8);
        const double *first = fixture_event(&f, EVENT_DETONATION, 0)->detonation.point;
        before += hypot(first[0] - 25000.0, first[2] - 25000.0) / MISSIONS;
        after += mean_miss(all - 12, 25000.0, 25000.0) / MISSIONS;
        rounds += (double)(all - 12) / MISSIONS;
    }
    expect("adjustment, 8 km: first round misses by [m]", 60.0, 250.0, before);
    expect("  mean of the fire for effect misses by [m]", 0.0, 60.0, after);
    expect("  rounds for adjustment", 2.0, 7.0, rounds);
}

static void test_without_an_observer_nothing_is_corrected(void **state)
{
    uint32_t gun = put("howitzer", 17000.0, 25000.0, FORCE_BLUE);
    (void)state;
    put("jeep", 24000.0, 25000.0, FORCE_RED); /* sees the target, for the enemy */
    assert_true(begin(&(struct fire_mission_order){.x = 25000.0,
                                                   .z = 25000.0,
                                                   .gun = gun,
                                                   .rounds = 3,
                                                   .munition = KIND_NONE,
                                                   .fuze = FUZE_COUNT,
                                                   .adjusted = true}));
    fixture_run(&f, 60 * 150);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 4);
}

static void test_a_shell_from_off_the_map_strikes_at_its_time(void **state)
{
    (void)state;
    reopen("world = { seed = 1; capacity = 64; };\n"
           "fires = ( { at_s = 20.0; munition = \"artillery\"; point = [25000.0, 25000.0];\n"
           "            bearing_deg = 270.0; } );");
    fixture_run(&f, 60 * 17);
    struct entities e = steps_rows(&f);
    assert_true(e.row[0].vx > 200.0 && fabs(e.row[0].vz) < 5.0 && e.row[0].vy < -80.0);
    fixture_run(&f, 60 * 4);
    const struct event *event = fixture_event(&f, EVENT_DETONATION, 0);
    assert_non_null(event);
    expect("shell from afar: strikes at [s]", 19.95, 20.05, (double)event->tick / 60.0);
    expect("  misses its point by [m]", 0.0, 3.0,
           hypot(event->detonation.point[0] - 25000.0, event->detonation.point[2] - 25000.0));
}

static void test_a_battery_off_the_map_fires_a_mission(void **state)
{
    (void)state;
    reopen("world = { seed = 1; capacity = 64; };\n"
           "fires = ( { at_s = 20.0; munition = \"artillery\"; point = [25000.0, 25000.0];\n"
           "            rounds = 18; } );");
    fixture_run(&f, 60 * 60);
    assert_int_equal(fixture_event_count(&f, EVENT_DETONATION), 18);
    assert_true(mean_miss(0, 25000.0, 25000.0) < 200.0);
    const struct event *first = fixture_event(&f, EVENT_DETONATION, 0);
    expect("first shell of a battery afar [s]", 19.5, 20.5, (double)first->tick / 60.0);
}

static void test_fuzes(void **state)
{
    double radius[2] = {0.0, 0.0};
    (void)state;
    for (int fuze = 0; fuze < 3; fuze++) {
        char text[256];
        static const char *const word[] = {"point", "delay", "air"};
        (void)snprintf(text, sizeof text,
                       "world = { seed = 1; capacity = 64; };\n"
                       "fires = ( { at_s = 10.0; munition = \"artillery\"; fuze = \"%s\";\n"
                       "            point = [25000.0, 25000.0]; } );",
                       word[fuze]);
        reopen(text);
        fixture_run(&f, 60 * 11);
        const struct event_detonation *end = &fixture_event(&f, EVENT_DETONATION, 0)->detonation;
        const struct event *crater = fixture_event(&f, EVENT_CRATER, 0);
        if (fuze < 2) {
            assert_int_equal(end->struck, STRUCK_GROUND);
            radius[fuze] = (double)crater->crater.radius_m;
            continue;
        }
        assert_int_equal(end->struck, STRUCK_AIR);
        assert_null(crater);
        expect("burst in the air: height [m]", 5.0, 11.0, end->point[1] - GROUND_M);
    }
    expect("crater with delay, over that without", 1.3, 1.6, radius[1] / radius[0]);
}

static void test_an_aircraft_releases_its_bomb(void **state)
{
    (void)state;
    uint32_t jet = fixture_put(&f, (struct fixture_entity){.kind = "jet",
                                                           .at = {25000.0, 800.0, 25000.0},
                                                           .velocity = {200.0, 0.0, 0.0}});
    struct step_context step;
    struct serial_context context;
    steps_serial_context(&f, &step, &context);
    assert_true(fire_shoot_at(&context, jet, 30000.0, 25000.0, fixture_kind(&f, "bomb")));
    struct entities m = f.view.m.entities;
    assert_true(m.row[1].vx == 200.0 && m.row[1].vy == 0.0 && m.row[1].y < 800.0 &&
                m.row[1].x == 25000.0);
    struct vec3 at = entities_position(&m, 1), velocity = entities_velocity(&m, 1);
    double time = firing_arc_fall(steps_kind(&f, "bomb"), step.wind, GROUND_M, &at, &velocity);
    expect("bomb from 700 m: falls for [s]", 11.7, 12.3, time);
    expect("  and flies on for [m]", 2200.0, 2400.0, at.x - 25000.0);
}

static uint64_t digest_on(uint32_t threads)
{
    reopen("world = { seed = 3; capacity = 256; wind_mps = 8; wind_from_deg = 250; };\n"
           "vehicles = ( { kind = \"howitzer\"; count = 5; name = \"gun\"; force = \"blue\";\n"
           "               behaviour = \"idle\"; area = [17000.0, 25000.0, 17100.0, 25200.0]; },\n"
           "             { kind = \"jeep\"; force = \"blue\"; behaviour = \"idle\";\n"
           "               at = [24000.0, 25000.0]; },\n"
           "             { kind = \"tank\"; count = 8; force = \"red\"; behaviour = \"idle\";\n"
           "               area = [24950.0, 24950.0, 25100.0, 25100.0]; } );\n"
           "fires = ( { at_s = 1.0; shooter = \"gun-1\"; rounds = 12; adjust = true;\n"
           "            point = [25000.0, 25000.0]; },\n"
           "          { at_s = 30.0; munition = \"artillery\"; rounds = 12;\n"
           "            point = [25050.0, 25050.0]; } );");
    fixture_threads(&f, threads);
    fixture_run(&f, 60 * 300);
    assert_true(fixture_state(&f).head->tally.detonations >= 24);
    return fixture_digest(&f);
}

static void test_the_digest_does_not_depend_on_threads(void **state)
{
    (void)state;
    uint64_t one = digest_on(1);
    assert_true(digest_on(2) == one);
    assert_true(digest_on(4) == one);
}

static void test_orders_that_cannot_be_carried_out(void **state)
{
    uint32_t tank = put("tank", 15000.0, 25000.0, FORCE_BLUE);
    uint32_t gun = put("howitzer", 15500.0, 25000.0, FORCE_BLUE);
    struct step_context step;
    struct serial_context context;
    (void)state;
    assert_false(begin(&(struct fire_mission_order){.gun = tank, .rounds = 3}));
    assert_false(begin(&(struct fire_mission_order){.gun = gun, .rounds = 0}));
    assert_true(begin(&(struct fire_mission_order){
        .x = 45000.0, .z = 25000.0, .gun = gun, .rounds = 3, .munition = KIND_NONE}));
    steps_serial_context(&f, &step, &context);
    assert_int_equal(fire_mission_gun(&context, FORCE_BLUE, 25000.0, 25000.0), SLOT_NONE);
    fixture_run(&f, 60); /* out of range */
    assert_int_equal(fixture_state(&f).head->battery_count, 0);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 0);
    steps_serial_context(&f, &step, &context);
    assert_int_equal(fire_mission_gun(&context, FORCE_BLUE, 25000.0, 25000.0), gun);
    assert_int_equal(fire_mission_gun(&context, FORCE_RED, 25000.0, 25000.0), SLOT_NONE);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_probable_errors_of_200_rounds),
        TEST(test_a_gun_fires_four_a_minute_for_three_minutes_and_then_one),
        TEST(test_an_observer_brings_the_fire_to_the_target),
        TEST(test_without_an_observer_nothing_is_corrected),
        TEST(test_a_shell_from_off_the_map_strikes_at_its_time),
        TEST(test_a_battery_off_the_map_fires_a_mission),
        TEST(test_fuzes),
        TEST(test_an_aircraft_releases_its_bomb),
        TEST(test_the_digest_does_not_depend_on_threads),
        TEST(test_orders_that_cannot_be_carried_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
