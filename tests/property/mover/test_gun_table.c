/* The acceptance table of guns: quantity, real, ours. Rounds are flown by the mover, and dispersion
 * is that of rounds that a tank fires. Sources: Foss, Jane's Armour and Artillery; FM 17-12; FM
 * 6-40; the standard drag functions G1 and G7, integrated apart from Jolon. */
#include "mover/weapon/fire.h"
#include "mover/weapon/firing_table.h"
#include "tests/support/steps.h"
#include "world/entity/armour.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define SQUARE_M 2.3  /* a tank or carrier */
#define JEEP_M   1.65 /* a jeep, as wide and high */
#define ROUNDS   1500u

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 2048; };");
    return 0;
}

static void row_of(const char *what, double real, double low, double high, double ours)
{
    print_message("# %-46s %9.4g %9.4g\n", what, real, ours);
    if (!(ours >= low && ours <= high))
        fail_msg("%s: %g; right would be %g to %g", what, ours, low, high);
}

/* within: the tolerance as a share of the real figure. */
static void row_within(const char *what, double real, double within, double ours)
{
    row_of(what, real, real * (1.0 - within), real * (1.0 + within), ours);
}

/* --- flight ------------------------------------------------------------------------------------*/

/* Flies a round level to a distance. Returns its time, and its speed there. */
static double fly(const char *kind, double far_m, double *speed_mps)
{
    double start = 20000.0, v = steps_kind(&f, kind)->max_speed_mps;
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                           .at = {start, 150.0, 25000.0},
                                                           .velocity = {v, 0.0, 0.0}});
    struct entities e = steps_rows(&f);
    int frames = 0;
    double before = start;
    while (e.row[row].x - start < far_m && frames < 600) {
        before = e.row[row].x;
        fixture_run(&f, 1);
        e = steps_rows(&f);
        frames++;
    }
    *speed_mps = vec3_length(entities_velocity(&e, row));
    return ((double)frames - (e.row[row].x - start - far_m) / (e.row[row].x - before)) / 60.0;
}

static void test_flight(void **state)
{
    double speed;
    (void)state;
    row_within("sabot to 2 km [s]", 1.40, 0.03, fly("shell", 2000.0, &speed));
    row_within("  speed there [m/s]", 1364.0, 0.03, speed);
    row_within("shaped charge to 2 km [s]", 2.2, 0.05, fly("heat", 2000.0, &speed));
    row_within("  speed there [m/s]", 710.0, 0.05, speed);
    row_within("12.7 mm ball to 1 km [s]", 1.53, 0.03, fly("bullet", 1000.0, &speed));
    row_within("  speed there [m/s]", 481.0, 0.03, speed);
}

static void test_howitzer(void **state)
{
    const struct firing_arc *arc =
        &f.stepper.mover.firing_tables[fixture_kind(&f, "artillery")].arc;
    struct firing_arc_solution solution;
    struct firing_arc_aim aim = {.muzzle = {10000.0, 0.0, 25000.0},
                                 .point = {20000.0, 0.0, 25000.0}};
    (void)state;
    row_within("155 mm, furthest [m]", 14600.0, 0.02, arc->range_m[arc->furthest]);
    assert_true(firing_arc_solve(arc, &aim, &solution));
    row_within("  to 10 km [s]", 28.9, 0.02, solution.flight_s);
    row_of("  elevation [degrees]", 18.5, 18.0, 19.0, solution.elevation_rad / RAD_PER_DEG);
    row_within("  strikes with [m/s]", 301.0, 0.02, vec3_length(solution.fall));
    aim.high = true;
    assert_true(firing_arc_solve(arc, &aim, &solution));
    row_within("  high arc [s]", 79.0, 0.02, solution.flight_s);
}

/* --- dispersion --------------------------------------------------------------------------------*/

/* Fires rounds at a point and returns the share that passes a square around the mean at this range.
 * speed: of the shooter, as a share of its top speed. */
static double hits(const char *shooter, double square_m, double speed, double range_m)
{
    struct step_context step;
    struct serial_context context;
    steps_empty(&f);
    double most = steps_kind(&f, shooter)->max_speed_mps;
    steps_kind(&f, shooter)->rounds = 2 * ROUNDS;
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = shooter,
                                                .at = {25000.0, FIXTURE_GROUND_M, 25000.0},
                                                .velocity = {0.0, 0.0, -speed * most}});
    steps_rows(&f).row[row].rounds = 2 * ROUNDS;
    steps_serial_context(&f, &step, &context);
    struct vec3 mean = {0.0, 0.0, 0.0};
    uint32_t used = f.view.m.head->used, in = 0;
    for (uint32_t n = 0; n < ROUNDS; n++) {
        assert_true(fire_shoot_at(&context, row, 25000.0, 25000.0 - range_m, KIND_NONE));
        mean = vec3_add(mean, entities_velocity(&f.view.m.entities, used + n));
    }
    for (uint32_t n = 0; n < ROUNDS; n++) {
        struct vec3 v = entities_velocity(&f.view.m.entities, used + n);
        double far = range_m / v.z;
        in += fabs(v.x * far - mean.x / mean.z * range_m) <= 0.5 * square_m &&
              fabs(v.y * far - mean.y / mean.z * range_m) <= 0.5 * square_m;
    }
    return (double)in / ROUNDS;
}

static void test_dispersion(void **state)
{
    static const double real[2][3] = {{0.96, 0.56, 0.31}, {0.56, 0.19, 0.09}};
    (void)state;
    for (int moving = 0; moving < 2; moving++) {
        for (int km = 1; km <= 3; km++) {
            char what[64];
            double p = real[moving][km - 1];
            snprintf(what, sizeof what, "2.3 m square at %d km, %s", km,
                     moving ? "moving" : "halted");
            row_of(what, p, p - 0.04, p + 0.04,
                   hits("tank", SQUARE_M, moving ? 0.6 : 0.0, 1000.0 * km));
        }
    }
}

/* A round of a carrier's burst errs by 0.5 mrad about the aim, and the aim by 0.5 mrad, or by 1.4
 * mrad as it drives. The real shares are those of the normal distribution. */
static void test_bursts(void **state)
{
    static const struct {
        const char *at;
        double square_m, range_m, real[2]; /* halted, moving */
    } row[] = {{"a jeep at 0.6 km", JEEP_M, 600.0, {0.90, 0.41}},
               {"a jeep at 0.9 km", JEEP_M, 900.0, {0.66, 0.21}},
               {"a jeep at 1.2 km", JEEP_M, 1200.0, {0.45, 0.12}},
               {"a carrier at 1 km", SQUARE_M, 1000.0, {0.81, 0.31}},
               {"a carrier at 1.5 km", SQUARE_M, 1500.0, {0.53, 0.15}}};
    (void)state;
    for (size_t n = 0; n < sizeof row / sizeof row[0]; n++) {
        for (int moving = 0; moving < 2; moving++) {
            char what[64];
            double p = row[n].real[moving];
            snprintf(what, sizeof what, "burst at %s, %s", row[n].at, moving ? "moving" : "halted");
            row_of(what, p, p - 0.04, p + 0.04,
                   hits("carrier", row[n].square_m, moving ? 0.6 : 0.0, row[n].range_m));
        }
    }
}

/* --- penetration and rates ---------------------------------------------------------------------*/

static void test_penetration(void **state)
{
    const struct kind *sabot = steps_kind(&f, "shell"), *heat = steps_kind(&f, "heat");
    (void)state;
    row_within("sabot at the muzzle [mm]", 400.0, 0.05, armour_penetration(sabot, 0.0));
    row_within("  at 2 km [mm]", 350.0, 0.05, armour_penetration(sabot, 2000.0));
    row_within("shaped charge at 2 km [mm]", 380.0, 0.05, armour_penetration(heat, 2000.0));
    row_of("tank, front [mm]", 375.0, 350.0, 400.0, steps_kind(&f, "tank")->armour_mm[0]);
    row_of("tank, side [mm]", 60.0, 40.0, 75.0, steps_kind(&f, "tank")->armour_mm[1]);
}

static void test_rates(void **state)
{
    const struct kind *tank = steps_kind(&f, "tank"), *gun = steps_kind(&f, "howitzer");
    (void)state;
    row_of("tank, rounds a minute", 8.0, 6.0, 10.0, 60.0 / tank->reload_s);
    row_of("  turret [degrees/s]", 40.0, 38.0, 42.0, tank->turret_rate_rps / RAD_PER_DEG);
    row_of("  gun down [degrees]", -10.0, -10.5, -9.5, tank->gun_low_rad / RAD_PER_DEG);
    row_of("  gun up [degrees]", 20.0, 19.5, 20.5, tank->gun_high_rad / RAD_PER_DEG);
    row_of("howitzer, rounds a minute at first", 4.0, 4.0, 4.0, 60.0 / gun->reload_s);
}

/* Turns the turret of a driven vehicle for a second, and its gun as far as it goes. */
static void turn_turret(const char *kind, double rate, double low, double high)
{
    steps_empty(&f);
    uint32_t row = fixture_put(
        &f, (struct fixture_entity){.kind = kind, .at = {25000.0, FIXTURE_GROUND_M, 25000.0}});
    char what[64];
    steps_drive(&f, row, 0.0, 0.0, 0.0);
    steps_rows(&f).row[row].traverse = 1.0f;
    double before = (double)steps_rows(&f).row[row].turret;
    fixture_run(&f, 60);
    snprintf(what, sizeof what, "%s, turret turns in a second [degrees]", kind);
    row_within(what, rate, 0.05, ((double)steps_rows(&f).row[row].turret - before) / RAD_PER_DEG);
    for (int end = 0; end < 2; end++) {
        double real = end ? high : low;
        steps_rows(&f).row[row].elevate = end ? 1.0f : -1.0f;
        fixture_run(&f, 300);
        steps_rows(&f).row[row].until_tick = UINT32_MAX;
        row_of(end ? "  gun up [degrees]" : "  gun down [degrees]", real, real - 0.5, real + 0.5,
               (double)steps_rows(&f).row[row].gun / RAD_PER_DEG);
    }
}

static void test_turrets(void **state)
{
    (void)state;
    turn_turret("tank", 40.0, -10.0, 20.0);
    turn_turret("carrier", 60.0, -10.0, 57.0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_flight),      TEST(test_howitzer), TEST(test_dispersion), TEST(test_bursts),
        TEST(test_penetration), TEST(test_rates),    TEST(test_turrets),
    };
    print_message("# %-46s %9s %9s\n", "quantity", "real", "ours");
    return cmocka_run_group_tests(tests, NULL, NULL);
}
