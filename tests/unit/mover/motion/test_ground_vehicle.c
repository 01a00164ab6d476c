/* Land vehicles: the terrain under them, slopes, water, the edge of the world, the brakes. */
#include "mover/motion/chassis_shell.h"
#include "tests/support/steps.h"
#include "world/cruise_pose.h"
#include "world/entity/cruise.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/rest_pose.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ         60.0
#define DIRT       0.65 /* friction of its cover */
#define SPEED_MPS  0.1  /* to which a driven vehicle keeps its speed on its springs */
#define FLOAT_POST 1e-4 /* [rad] what posts as floats leave of an angle */

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static uint32_t put(const char *kind, double x, double z, double heading_deg, double speed_mps)
{
    return steps_put_driving(&f, kind, x, z, heading_deg, speed_mps);
}

static uint32_t put_tank(double x, double z, double heading_deg, double speed_mps)
{
    return put("tank", x, z, heading_deg, speed_mps);
}

static bool near(double value, double wanted, double slack)
{
    return fabs(value - wanted) <= slack;
}

/* --- the ground underneath ---------------------------------------------------------------------*/

static void test_row_15_a_plane_gives_pitch_and_roll(void **state)
{
    static const double slopes_deg[] = {-30.0, -10.0, 0.0, 5.0, 20.0, 30.0};
    (void)state;
    for (size_t n = 0; n < sizeof slopes_deg / sizeof slopes_deg[0]; n++) {
        double slope = slopes_deg[n] * RAD_PER_DEG;
        fixture_close(&f);
        fixture_open(&f, "");
        steps_plane(&f, maths_sin(slope) / maths_cos(slope), 0.0); /* rises to the east */
        uint32_t east = put_tank(25010.0, 25010.0, 90.0, 0.0);
        uint32_t north = put_tank(25010.0, 25060.0, 0.0, 0.0);
        uint32_t west = put_tank(25010.0, 24960.0, 270.0, 0.0);
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        assert_true(near(e.row[east].pitch, slope, FLOAT_POST) &&
                    near(e.row[east].roll, 0.0, FLOAT_POST));
        assert_true(near(e.row[west].pitch, -slope, FLOAT_POST));
        /* Heading north, its right side is uphill: up, so roll, right side down, is negative. */
        assert_true(near(e.row[north].roll, -slope, FLOAT_POST));
        assert_true(near(e.row[north].pitch, 0.0, FLOAT_POST));
    }
}

static double bumpy(double x, double z, const void *context)
{
    (void)context;
    return 100.0 + 6.0 * maths_sin(x * 0.013) + 6.0 * maths_sin(z * 0.017 + 1.0);
}

static void test_row_15_it_stays_on_the_ground_in_every_frame(void **state)
{
    (void)state;
    steps_ground(&f, bumpy, NULL);
    uint32_t row = put_tank(25000.0, 25000.0, 60.0, 10.0);
    for (int frame = 0; frame < 600; frame++) {
        steps_drive(&f, row, 1.0, frame % 200 < 100 ? 0.3 : -0.3, 0.0);
        struct entities e = steps_rows(&f);
        assert_true(near(e.row[row].y, steps_ground_at(&f, e.row[row].x, e.row[row].z), 0.4));
    }
    assert_true(hypot(steps_rows(&f).row[row].x - 25000.0, steps_rows(&f).row[row].z - 25000.0) >
                50.0);
}

/* --- slopes ------------------------------------------------------------------------------------*/

/* Speed [m/s] that full throttle comes to on a slope. */
static double speed_on(double slope_deg)
{
    double slope = slope_deg * RAD_PER_DEG;
    fixture_close(&f);
    fixture_open(&f, "");
    steps_plane(&f, maths_sin(slope) / maths_cos(slope), 0.0);
    uint32_t row = put_tank(25000.0, 25010.0, 90.0, 0.0);
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(30.0 * HZ));
    struct entities e = steps_rows(&f);
    return hypot(e.row[row].vx, e.row[row].vz);
}

static void test_slopes_limit_speed(void **state)
{
    double full = steps_kind(&f, "tank")->max_speed_mps, before = full;
    (void)state;
    assert_true(near(speed_on(0.0), full, SPEED_MPS));
    assert_true(near(speed_on(-15.0), full * maths_cos(15.0 * RAD_PER_DEG),
                     SPEED_MPS)); /* downhill nothing holds it */
    for (double slope = 5.0; slope < 31.0; slope += 5.0) {
        double speed = speed_on(slope);
        assert_true(speed > 0.05 * full && speed < before - 0.01 * full);
        before = speed;
    }
}

static void test_ground_steeper_than_max_slope_is_not_climbed(void **state)
{
    (void)state;
    assert_true(speed_on(31.5) < 0.01);
}

/* Puts an agent on a plane that rises to the east, and lets it drive straight for some seconds.
 * Returns true if it was on its springs. */
static bool springs_on(double slope_deg, double heading_deg)
{
    double slope = slope_deg * RAD_PER_DEG, heading = heading_deg * RAD_PER_DEG;
    bool springs = false;
    fixture_close(&f);
    fixture_open(&f, "");
    steps_plane(&f, maths_sin(slope) / maths_cos(slope), 0.0);
    uint32_t row = put_tank(25010.0, 25010.0, heading_deg, 0.0);
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_PATROL;
    e.row[row].goal_x = 25010.0 + 2000.0 * maths_sin(heading);
    e.row[row].goal_z = 25010.0 - 2000.0 * maths_cos(heading);
    for (int frame = 0; frame < 5 * (int)HZ; frame++) {
        fixture_run(&f, 1);
        springs |= (steps_rows(&f).row[row].flags & ENTITY_FLAG_CHASSIS) != 0;
    }
    assert_true(springs || steps_speed(&f, row) > 0.3);
    return springs;
}

/* Beyond 25 degrees the slope itself is no reason, as long as the tyres hold the vehicle. */
static void test_it_follows_an_even_slope_that_it_does_not_slide_down(void **state)
{
    (void)state;
    for (double heading = 0.0; heading < 360.0; heading += 90.0)
        assert_false(springs_on(27.0, heading));
    assert_true(springs_on(35.0, 180.0) && springs_on(35.0, 270.0));
}

static double cliff(double x, double z, const void *slope)
{
    (void)z;
    return 100.0 + (x > 25000.0 ? (x - 25000.0) * *(const double *)slope : 0.0);
}

static void test_a_vehicle_stops_at_the_foot_of_a_cliff_and_climbs_a_hill(void **state)
{
    double steep = 1.0, gentle = 0.3;
    (void)state;
    steps_ground(&f, cliff, &steep);
    uint32_t row = put_tank(24970.0, 25010.0, 90.0, 3.0);
    steps_drive(&f, row, 0.2, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(30.0 * HZ));
    assert_true(steps_rows(&f).row[row].x < 25004.0 && steps_rows(&f).row[row].x > 24990.0);
    assert_true(steps_speed(&f, row) < 0.02);
    steps_ground(&f, cliff, &gentle);
    fixture_run(&f, (uint32_t)(20.0 * HZ));
    assert_true(steps_rows(&f).row[row].x > 25030.0);
}

/* --- borders -----------------------------------------------------------------------------------*/

static void test_deep_water_stops_it(void **state)
{
    (void)state;
    steps_cover(&f, COVER_LAKE, 25125.0, 0.0, 50000.0, 50000.0); /* from x = 25062.5 on */
    uint32_t row = put_tank(25045.0, 25010.0, 90.0, 3.0);
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    for (int frame = 0; frame < (int)(40.0 * HZ); frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        if (e.row[row].x > 25072.5) /* it fords no faster */
            assert_true(steps_speed(&f, row) < 2.0 + SPEED_MPS);
    }
    /* The ground falls by a twentieth. */
    double bow = steps_rows(&f).row[row].x + 0.5 * steps_kind(&f, "tank")->length_m;
    double deep = 25062.5 + steps_kind(&f, "tank")->ford_m / 0.05;
    assert_true(bow <= deep + 0.02 && bow > deep - 1.5);
    assert_true(steps_speed(&f, row) < 0.5);
}

/* An agent that runs into a lake stops by its brakes, in the water. It stopped within a frame. */
static void test_water_stops_no_vehicle_within_a_frame(void **state)
{
    double most_mps2 = 0.0, farthest = 0.0;
    (void)state;
    steps_cover(&f, COVER_LAKE, 25125.0, 0.0, 50000.0, 50000.0); /* from x = 25062.5 on */
    uint32_t row = put_tank(25058.0, 25010.0, 90.0, 10.0);
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = BEHAVIOUR_PATROL;
    e.row[row].goal_x = 25200.0;
    e.row[row].goal_z = 25010.0;
    for (int frame = 0; frame < 10 * (int)HZ; frame++) {
        double vx = steps_rows(&f).row[row].vx, vz = steps_rows(&f).row[row].vz;
        fixture_run(&f, 1);
        e = steps_rows(&f);
        most_mps2 = maths_max(most_mps2, HZ * hypot(e.row[row].vx - vx, e.row[row].vz - vz));
        farthest = maths_max(farthest, e.row[row].x);
    }
    double bow = farthest + 0.5 * steps_kind(&f, "tank")->length_m;
    assert_true(most_mps2 < 12.0);
    assert_true(farthest > 25062.5 && bow < 25062.5 + steps_kind(&f, "tank")->ford_m / 0.05);
    assert_true(steps_rows(&f).row[row].x < 25062.5); /* it is out again */
}

static void test_it_can_back_away_from_the_shore(void **state)
{
    (void)state;
    steps_cover(&f, COVER_LAKE, 25125.0, 0.0, 50000.0, 50000.0);
    uint32_t row = put_tank(25030.0, 25010.0, 90.0, 16.0);
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(5.0 * HZ));
    double stopped = steps_rows(&f).row[row].x;
    steps_drive(&f, row, -1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(8.0 * HZ));
    assert_true(steps_rows(&f).row[row].x < stopped - 10.0);
}

static void test_the_worlds_edge_stops_it(void **state)
{
    static const double places[4][3] = {{50.0, 25000.0, 270.0},
                                        {WORLD_SIDE_DEFAULT_M - 50.0, 25000.0, 90.0},
                                        {25000.0, 50.0, 0.0},
                                        {25000.0, WORLD_SIDE_DEFAULT_M - 50.0, 180.0}};
    (void)state;
    for (int n = 0; n < 4; n++) {
        uint32_t row = put_tank(places[n][0], places[n][1], places[n][2], 16.0);
        steps_drive(&f, row, 1.0, 0.0, 0.0);
        fixture_run(&f, (uint32_t)(10.0 * HZ));
        struct entities e = steps_rows(&f);
        assert_in_range((uint64_t)e.row[row].x, 1, (uint64_t)WORLD_SIDE_DEFAULT_M - 1);
        assert_in_range((uint64_t)e.row[row].z, 1, (uint64_t)WORLD_SIDE_DEFAULT_M - 1);
        assert_true(steps_speed(&f, row) < 0.5);
    }
}

/* --- engine, brakes, wheels --------------------------------------------------------------------*/

static void test_it_gains_speed_at_its_acceleration_and_brakes_as_the_ground_holds(void **state)
{
    const struct kind *kind = steps_kind(&f, "tank");
    uint32_t row = put_tank(25000.0, 25010.0, 90.0, 0.0);
    (void)state;
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)HZ - 1);
    assert_true(near(steps_speed(&f, row), kind->acceleration_mps2, SPEED_MPS));
    fixture_run(&f, (uint32_t)(30.0 * HZ)); /* the engine's power limits it further on */
    assert_true(near(steps_speed(&f, row), kind->max_speed_mps, SPEED_MPS));
    double from = steps_rows(&f).row[row].x;
    double stop_s = kind->max_speed_mps / (0.95 * DIRT * GRAVITY_MPS2);
    steps_pedals(&f, row, 1.0, 1.0, GEAR_AUTOMATIC); /* the brake outdoes the throttle */
    fixture_run(&f, (uint32_t)(stop_s * HZ) + 60);
    assert_true(near(steps_speed(&f, row), 0.0, 0.05));
    /* v squared over 2 a. */
    assert_true(near(steps_rows(&f).row[row].x - from, 0.5 * kind->max_speed_mps * stop_s,
                     0.1 * kind->max_speed_mps * stop_s));
}

static void test_a_throttle_let_go_slows_it_by_its_engine(void **state)
{
    const struct kind *kind = steps_kind(&f, "tank");
    uint32_t row = put_tank(25000.0, 25010.0, 90.0, 16.0);
    uint32_t half = put_tank(25000.0, 25500.0, 90.0, 16.0);
    (void)state;
    steps_pedals(&f, row, 0.0, 0.0, GEAR_AUTOMATIC);
    steps_pedals(&f, half, 0.0, 0.5, GEAR_AUTOMATIC);
    double before[2] = {steps_speed(&f, row), steps_speed(&f, half)};
    fixture_run(&f, (uint32_t)HZ);
    double rolling = 0.045 * GRAVITY_MPS2, engine = 0.5 * kind->acceleration_mps2;
    assert_true(near(before[0] - steps_speed(&f, row), engine + rolling, SPEED_MPS));
    double hardest = 0.95 * DIRT * GRAVITY_MPS2;
    assert_true(near(before[1] - steps_speed(&f, half), 0.5 * engine + 0.5 * hardest + rolling,
                     2.0 * SPEED_MPS));
}

static void test_reverse_gear_goes_backwards_by_the_throttle(void **state)
{
    double full = steps_kind(&f, "tank")->max_speed_mps;
    uint32_t row = put_tank(25000.0, 25010.0, 90.0, 8.0);
    (void)state;
    steps_pedals(&f, row, 1.0, 0.0, GEAR_REVERSE); /* brakes first */
    fixture_run(&f, (uint32_t)HZ);
    assert_true(near(steps_rows(&f).row[row].vx, 8.0 - DIRT * GRAVITY_MPS2, 0.3));
    fixture_run(&f, (uint32_t)(8.0 * HZ));
    assert_true(near(steps_rows(&f).row[row].vx, -0.4 * full, SPEED_MPS));
    steps_pedals(&f, row, -1.0, 0.0, GEAR_REVERSE);
    fixture_run(&f, (uint32_t)(8.0 * HZ));
    assert_true(steps_speed(&f, row) == 0.0);
}

static void test_in_neutral_it_rolls_and_the_slope_pulls(void **state)
{
    uint32_t level = put_tank(25000.0, 25010.0, 90.0, 5.0);
    (void)state;
    steps_pedals(&f, level, 1.0, 0.0, GEAR_NEUTRAL);
    double before = steps_speed(&f, level);
    fixture_run(&f, (uint32_t)HZ);
    assert_true(near(before - steps_speed(&f, level), 0.045 * GRAVITY_MPS2, 0.02));
    fixture_close(&f);
    fixture_open(&f, "");
    steps_plane(&f, 0.2, 0.0); /* rises to the east */
    uint32_t rolls = put_tank(25000.0, 25010.0, 90.0, 0.0);
    uint32_t held = put_tank(25000.0, 25500.0, 90.0, 0.0);
    steps_pedals(&f, rolls, 0.0, 0.0, GEAR_NEUTRAL);
    steps_pedals(&f, held, 0.0, 1.0, GEAR_NEUTRAL);
    fixture_run(&f, (uint32_t)(2.0 * HZ));
    double pull = GRAVITY_MPS2 * (maths_sin(maths_atan2(0.2, 1.0)) - 0.045);
    assert_true(near(steps_rows(&f).row[rolls].vx, -pull * (2.0 * HZ + 2.0) / HZ, 0.3));
    assert_true(steps_speed(&f, held) < 0.1);
    fixture_run(&f, (uint32_t)(60.0 * HZ));
    assert_true(steps_rows(&f).row[rolls].vx >= -steps_kind(&f, "tank")->max_speed_mps - SPEED_MPS);
}

static void test_low_gear_is_slow_and_strong(void **state)
{
    double full = steps_kind(&f, "tank")->max_speed_mps;
    (void)state;
    for (double slope_deg = 0.0; slope_deg < 45.0; slope_deg += 9.0) {
        double slope = slope_deg * RAD_PER_DEG;
        fixture_close(&f);
        fixture_open(&f, "");
        steps_plane(&f, maths_sin(slope) / maths_cos(slope), 0.0);
        uint32_t row = put_tank(25000.0, 25010.0, 90.0, 0.0);
        steps_pedals(&f, row, 1.0, 0.0, GEAR_LOW);
        fixture_run(&f, (uint32_t)(6.0 * HZ));
        struct entities e = steps_rows(&f);
        double speed = sqrt(e.row[row].vx * e.row[row].vx + e.row[row].vz * e.row[row].vz);
        if (slope_deg == 0.0)
            assert_true(near(speed, 0.35 * full, SPEED_MPS));
        else if (slope_deg < 30.0) /* as fast as the power allows */
            assert_true(speed > 1.5 && speed < 0.35 * full + SPEED_MPS);
    }
}

static void test_no_control_makes_a_number_that_is_none_or_passes_a_limit(void **state)
{
    const struct kind *kind = steps_kind(&f, "tank");
    uint64_t random = fixture_seed(41);
    uint32_t row = put_tank(25000.0, 25010.0, 90.0, 0.0);
    (void)state;
    steps_ground(&f, bumpy, NULL);
    steps_kind(&f, "tank")->resistance_j = 1e12; /* hard landings do not wreck it */
    for (int n = 0; n < 3000; n++) {
        double before = steps_speed(&f, row), heading = steps_rows(&f).row[row].heading;
        struct command command = {.type = COMMAND_DRIVE, .entity = steps_rows(&f).row[row].id};
        for (int v = 0; v < 5; v++)
            command.value[v] = floor(fixture_uniform(&random, -2.0, 3.0)) * 0.5;
        command.value[5] = floor(fixture_uniform(&random, 0.0, 3.0)) * 0.5;
        command.force = (uint16_t)(fixture_random(&random) % GEAR_COUNT);
        assert_int_equal(steps_command(&f, command).result, COMMAND_DONE);
        struct entities e = steps_rows(&f);
        double level = sqrt(e.row[row].vx * e.row[row].vx + e.row[row].vz * e.row[row].vz);
        assert_true(isfinite(e.row[row].x) && isfinite(e.row[row].y) && isfinite(e.row[row].z));
        assert_true(level <= 1.1 * kind->max_speed_mps && isfinite(before));
        assert_true(fabs(maths_wrap_half(e.row[row].heading - heading)) <=
                    1.5 * kind->turn_rate_rps / HZ);
    }
}

static void test_it_reverses_at_two_fifths(void **state)
{
    uint32_t row = put_tank(25000.0, 25010.0, 90.0, 0.0);
    (void)state;
    steps_drive(&f, row, -1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(8.0 * HZ));
    assert_true(
        near(steps_rows(&f).row[row].vx, -0.4 * steps_kind(&f, "tank")->max_speed_mps, SPEED_MPS));
}

/* Brakes that work past a standstill would push: 0.6 m/s in a frame of 0.1 s. */
static void test_an_agent_stops_before_it_backs_off(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "world = { hz = 10.0; };");
    steps_plane(&f, 0.0, 0.0);
    uint32_t tank = put_tank(25010.0, 25010.0, 90.0, 0.1);
    struct entities e = steps_rows(&f);
    e.row[tank].behaviour = BEHAVIOUR_BACK_OFF;
    e.row[tank].until_tick = 1000;
    e.row[tank].bump_heading = (float)(1.5 * HALF_PI * 2.0);
    double least = 0.0;
    for (int frame = 0; frame < 5; frame++) {
        double before = steps_rows(&f).row[tank].vx;
        fixture_run(&f, 1);
        least = maths_min(least, steps_rows(&f).row[tank].vx);
        assert_true(before <= 0.0 || steps_rows(&f).row[tank].vx >= 0.0);
    }
    assert_true(least < 0.0);
}

static void test_it_turns_as_fast_as_the_ground_holds(void **state)
{
    double rate = steps_kind(&f, "tank")->turn_rate_rps;
    uint32_t rolls = put_tank(25000.0, 25010.0, 90.0, 10.0);
    uint32_t stands = put_tank(25000.0, 25500.0, 90.0, 0.0);
    (void)state;
    steps_drive(&f, rolls, 0.6, 1.0, 0.0);
    steps_drive(&f, stands, 0.0, 1.0, 0.0);
    double rolling = steps_rows(&f).row[rolls].heading,
           standing = steps_rows(&f).row[stands].heading;
    fixture_run(&f, (uint32_t)HZ);
    struct entities e = steps_rows(&f);
    double turning = maths_wrap_half(e.row[rolls].heading - rolling);
    double turned = maths_wrap_half(e.row[stands].heading - standing);
    assert_true(turning > 0.2 * rate && turning < DIRT * GRAVITY_MPS2 / 10.0);
    assert_true(turned > 0.1 * rate && turned < rate);
}

static void test_a_sideways_slide_is_braked_by_its_tyres(void **state)
{
    uint32_t row = put_tank(25000.0, 25010.0, 90.0, 0.0);
    struct entities e = steps_rows(&f);
    (void)state;
    e.row[row].vz = 10.0; /* to its right */
    steps_drive(&f, row, 0.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)HZ);
    assert_true(steps_rows(&f).row[row].vz > 1.0);
    fixture_run(&f, (uint32_t)(2.0 * HZ));
    assert_true(steps_speed(&f, row) < 0.05);
}

static void test_fuel_burns_with_the_throttle_and_an_empty_tank_stops_it(void **state)
{
    struct kind *kind = steps_kind(&f, "tank");
    uint32_t runs = put_tank(25000.0, 25010.0, 90.0, 16.67),
             idles = put_tank(25000.0, 25500.0, 90.0, 0.0);
    (void)state;
    kind->fuel_l = 1.0;
    kind->fuel_lps = 0.2;
    struct entities e = steps_rows(&f);
    e.row[runs].fuel_l = e.row[idles].fuel_l = 1.0;
    steps_drive(&f, runs, 0.5, 0.0, 0.0);
    steps_drive(&f, idles, 0.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(5.0 * HZ));
    assert_true(near(steps_rows(&f).row[runs].fuel_l, 0.5, 0.01));
    assert_true(near(steps_rows(&f).row[idles].fuel_l, 1.0 - 0.15 * 0.2 * 5.0, 0.001));
    fixture_run(&f, (uint32_t)(12.0 * HZ));
    assert_true(steps_rows(&f).row[runs].fuel_l == 0.0 && steps_speed(&f, runs) < 0.05);
}

/* Litres an hour that a kind burns while its engine idles, on its wheels and on its springs. */
static void idle_lph(const char *name, double real_lph)
{
    uint32_t follows =
        fixture_put(&f, (struct fixture_entity){.kind = name, .at = {25000.0, 100.0, 25500.0}});
    uint32_t springs =
        fixture_put(&f, (struct fixture_entity){.kind = name, .at = {25000.0, 100.0, 25900.0}});
    struct entities e = steps_rows(&f);
    e.row[follows].behaviour = e.row[follows].order = BEHAVIOUR_FLEE; /* and is in its place */
    e.row[follows].goal_x = e.row[follows].x, e.row[follows].goal_z = e.row[follows].z;
    e.row[follows].until_tick = UINT32_MAX;
    steps_drive(&f, springs, 0.0, 0.0, 0.0);
    double before[2] = {steps_rows(&f).row[follows].fuel_l, steps_rows(&f).row[springs].fuel_l};
    fixture_run(&f, (uint32_t)(4.0 * HZ));
    double lph[2] = {(before[0] - steps_rows(&f).row[follows].fuel_l) * 900.0,
                     (before[1] - steps_rows(&f).row[springs].fuel_l) * 900.0};
    print_message("acceptance: | %s idles, l/h | %.0f | %.1f |\n", name, real_lph, lph[1]);
    assert_true(near(lph[0], lph[1], 0.05) && near(lph[1], real_lph, 0.1 * real_lph));
    steps_empty(&f);
}

static void test_an_engine_that_idles_burns_what_those_of_its_sort_burn(void **state)
{
    (void)state;
    idle_lph("tank", 38.0);
    idle_lph("carrier", 8.0);
    idle_lph("truck", 2.0);
    idle_lph("jeep", 1.0);
}

static void test_the_engine_is_off_where_a_vehicle_has_the_order_to_stand(void **state)
{
    struct kind *kind = steps_kind(&f, "tank");
    struct fixture_entity stands = {.kind = "tank", .at = {25000.0, 100.0, 25500.0}};
    uint32_t parked = fixture_put(&f, stands), flees;
    (void)state;
    stands.at.z = 25900.0;
    flees = fixture_put(&f, stands);
    kind->fuel_l = 1.0;
    kind->fuel_lps = 0.2;
    struct entities e = steps_rows(&f);
    e.row[parked].fuel_l = e.row[flees].fuel_l = 1.0;
    e.row[parked].flags = e.row[flees].flags = ENTITY_FLAG_STAND;
    e.row[parked].behaviour = e.row[parked].order = e.row[flees].order = BEHAVIOUR_IDLE;
    e.row[flees].behaviour = BEHAVIOUR_FLEE; /* and stands: it is in its place */
    e.row[flees].goal_x = e.row[flees].x;
    e.row[flees].goal_z = e.row[flees].z;
    e.row[flees].until_tick = UINT32_MAX;
    fixture_run(&f, (uint32_t)(2.0 * HZ));
    assert_true(steps_rows(&f).row[parked].fuel_l == 1.0);
    assert_true(steps_rows(&f).row[flees].fuel_l < 1.0 - 0.14 * 0.2 * 2.0);
}

/* --- debris ------------------------------------------------------------------------------------*/

/* A fallen tree of radius 6 m at (25100, 25010), in both buffers: it fell some frames ago. */
static void fell_tree(double keep)
{
    fixture_close(&f);
    fixture_open(&f, "objects = ( { kind = \"tree\"; at = [25100.0, 25010.0]; } );");
    struct fixed_object *tree = (struct fixed_object *)(uintptr_t)f.view.world.fixed;
    tree->radius_m = 6.0f;
    /* All of it is loose and in the way, so heavy that a tank keeps this share of its speed. */
    struct kind *kind = steps_kind(&f, "tree");
    kind->debris_keep = 0.0;
    kind->length_m = kind->width_m = 1.0;
    kind->mass_kg = steps_kind(&f, "tank")->mass_kg * (1.0 / keep - 1.0);
    for (int buffer = 0; buffer < 2; buffer++) {
        f.view.w[buffer].fixed_damage[0] = DAMAGE_HIGH;
        f.view.w[buffer].head->tally.fixed_damaged = 1;
    }
}

static void test_debris_slows_vehicles(void **state)
{
    const struct kind *kind = steps_kind(&f, "tank");
    double full = kind->max_speed_mps, brakes = DIRT * GRAVITY_MPS2;
    (void)state;
    fell_tree(0.5);
    uint32_t row = put_tank(25040.0, 25010.0, 90.0, full);
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    double slowest = full, before = full;
    while (steps_rows(&f).row[row].x < 25120.0) {
        double x = steps_rows(&f).row[row].x;
        fixture_run(&f, 1);
        double speed = steps_speed(&f, row);
        if (fabs(x - 25100.0) < 5.9) /* on it: braked, no harder than it can */
            assert_true(speed < before && speed > before - 1.2 * brakes / HZ);
        else if (x < 25093.9)
            assert_true(near(speed, full, SPEED_MPS));
        slowest = maths_min(slowest, speed);
        before = speed;
    }
    assert_true(slowest < 0.9 * full && slowest > 0.5 * full);
    fixture_run(&f, (uint32_t)(30.0 * HZ));
    assert_true(near(steps_speed(&f, row), full, SPEED_MPS));
    /* A vehicle that creeps is not slowed. */
    uint32_t slow = put_tank(25090.0, 25010.0, 90.0, 0.4 * full);
    steps_drive(&f, slow, 0.4, 0.0, 0.0);
    fixture_run(&f, 60);
    assert_true(near(steps_speed(&f, slow), 0.4 * full, SPEED_MPS));
}

static void test_debris_keeps_to_its_share(void **state)
{
    double full = steps_kind(&f, "tank")->max_speed_mps;
    (void)state;
    fell_tree(0.25);
    uint32_t row = put_tank(25100.0, 25010.0, 90.0, 0.0);
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(2.0 * HZ)); /* a quarter of full speed by then, 4 m on */
    while (steps_rows(&f).row[row].x < 25105.9) {
        fixture_run(&f, 1);
        assert_true(near(steps_speed(&f, row), 0.25 * full, 0.3));
    }
}

/* Returns the speed of a vehicle after two seconds at full throttle over the debris. */
static double speed_over_debris(const char *kind)
{
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){
                            .kind = kind, .at = {25100.0, 100.0, 25010.0}, .heading_rad = HALF_PI});
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    fixture_run(&f, (uint32_t)(2.0 * HZ));
    double speed = steps_speed(&f, row);
    steps_empty(&f);
    for (int buffer = 0; buffer < 2; buffer++)
        f.view.w[buffer].fixed_damage[0] = DAMAGE_HIGH;
    return speed / steps_kind(&f, kind)->max_speed_mps;
}

static void test_debris_slows_by_the_masses_of_both(void **state)
{
    (void)state;
    fell_tree(0.5);
    struct kind *jeep = steps_kind(&f, "jeep"), *tree = steps_kind(&f, "tree");
    tree->mass_kg = 9.0 * jeep->mass_kg;
    assert_true(near(speed_over_debris("jeep"), 0.1, 0.005));
    tree->debris_keep = 0.5; /* half of it lies firm */
    assert_true(near(speed_over_debris("jeep"), 1.0 / 5.5, 0.005));
    jeep->power_w *= 9.0;
    jeep->mass_kg *= 9.0; /* a heavier vehicle pushes it more easily */
    assert_true(speed_over_debris("jeep") > 0.2);
    jeep->mass_kg /= 9.0;
    tree->length_m = 3.0 * jeep->length_m; /* it lies over six times the vehicle's rectangle */
    tree->width_m = 2.0 * jeep->width_m;
    double wide = speed_over_debris("jeep"), full = 0.0;
    assert_true(wide > 1.0 / 5.5); /* still gaining speed */
    tree->debris_keep = 1.0;
    full = speed_over_debris("jeep");
    assert_true(full >= wide);
}

static void test_what_stands_and_what_lies_aside_slows_nobody(void **state)
{
    double full = steps_kind(&f, "tank")->max_speed_mps;
    (void)state;
    fell_tree(0.2);
    uint32_t aside = put_tank(25060.0, 25017.0, 90.0, full); /* passes its edge by a metre */
    steps_drive(&f, aside, 1.0, 0.0, 0.0);
    for (int frame = 0; frame < 5 * (int)HZ; frame++) {
        fixture_run(&f, 1);
        assert_true(near(steps_speed(&f, aside), full, SPEED_MPS));
    }
    fell_tree(0.2);
    for (int buffer = 0; buffer < 2; buffer++)
        f.view.w[buffer].fixed_damage[0] = DAMAGE_MED;
    steps_params(&f)->collision.response = MODEL_NONE; /* it leans, and is driven through */
    uint32_t row = put_tank(25060.0, 25010.0, 90.0, full);
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    for (int frame = 0; frame < 5 * (int)HZ; frame++) {
        fixture_run(&f, 1);
        assert_true(near(steps_speed(&f, row), full, SPEED_MPS));
    }
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_row_15_a_plane_gives_pitch_and_roll),
        TEST(test_row_15_it_stays_on_the_ground_in_every_frame),
        TEST(test_slopes_limit_speed),
        TEST(test_ground_steeper_than_max_slope_is_not_climbed),
        TEST(test_it_follows_an_even_slope_that_it_does_not_slide_down),
        TEST(test_a_vehicle_stops_at_the_foot_of_a_cliff_and_climbs_a_hill),
        TEST(test_deep_water_stops_it),
        TEST(test_water_stops_no_vehicle_within_a_frame),
        TEST(test_it_can_back_away_from_the_shore),
        TEST(test_the_worlds_edge_stops_it),
        TEST(test_it_gains_speed_at_its_acceleration_and_brakes_as_the_ground_holds),
        TEST(test_a_throttle_let_go_slows_it_by_its_engine),
        TEST(test_reverse_gear_goes_backwards_by_the_throttle),
        TEST(test_in_neutral_it_rolls_and_the_slope_pulls),
        TEST(test_low_gear_is_slow_and_strong),
        TEST(test_no_control_makes_a_number_that_is_none_or_passes_a_limit),
        TEST(test_it_reverses_at_two_fifths),
        TEST(test_an_agent_stops_before_it_backs_off),
        TEST(test_it_turns_as_fast_as_the_ground_holds),
        TEST(test_a_sideways_slide_is_braked_by_its_tyres),
        TEST(test_fuel_burns_with_the_throttle_and_an_empty_tank_stops_it),
        TEST(test_an_engine_that_idles_burns_what_those_of_its_sort_burn),
        TEST(test_the_engine_is_off_where_a_vehicle_has_the_order_to_stand),
        TEST(test_debris_slows_vehicles),
        TEST(test_debris_keeps_to_its_share),
        TEST(test_debris_slows_by_the_masses_of_both),
        TEST(test_what_stands_and_what_lies_aside_slows_nobody),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
