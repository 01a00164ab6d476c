/* Wrecks fall, tumble, slide and come to rest in the pose that the ground gives them. */
#include "tests/support/steps.h"
#include "world/body_points.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define SOIL 0.7 /* friction of the ground; with a kind's the geometric mean counts */
#define HZ   60u

static struct fixture f;

static int open_world(void **state)
{
    *state = &f;
    fixture_open(&f, "");
    return 0;
}

static uint32_t put(const char *kind, double y, struct vec3 velocity)
{
    uint32_t row = fixture_put(
        &f,
        (struct fixture_entity){.kind = kind, .at = {25000.0, y, 25000.0}, .velocity = velocity});
    struct entities e = steps_rows(&f);
    e.row[row].state = ENTITY_WRECK;
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_IDLE;
    return row;
}

static double friction_of(const char *kind)
{
    return sqrt(SOIL * steps_kind(&f, kind)->friction);
}

static double spin_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return vec3_length((struct vec3){e.row[row].spin_x, e.row[row].spin_y, e.row[row].spin_z});
}

static double clearance_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    struct body_points points;
    body_points_of(&f.view.world, e.row[row].kind, &points);
    return body_points_clearance(
        &f.view.world, &f.stepper.mover.craters, &points, entities_position(&e, row),
        rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll));
}

static bool rests(uint32_t row)
{
    return steps_speed(&f, row) == 0.0 && spin_of(row) == 0.0 && steps_rows(&f).row[row].vy == 0.0;
}

/* How far its up axis is from the vertical. */
static double tilt_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    struct mat3 turn =
        rotation_matrix(rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll));
    return maths_atan2(sqrt(1.0 - turn.m[1][1] * turn.m[1][1]), turn.m[1][1]);
}

static void test_a_wreck_slides_to_rest_by_friction(void **state)
{
    (void)state;
    uint32_t row = put("tank", 100.0, (struct vec3){12.0, 0.0, 9.0});
    double way = 15.0 * 15.0 / (2.0 * friction_of("tank") * GRAVITY_MPS2);
    fixture_run(&f, 5 * HZ);
    struct entities e = steps_rows(&f);
    double slid = sqrt((e.row[row].x - 25000.0) * (e.row[row].x - 25000.0) +
                       (e.row[row].z - 25000.0) * (e.row[row].z - 25000.0));
    assert_true(rests(row) && tilt_of(row) < 0.01);
    assert_true(slid > 0.85 * way && slid < 1.02 * way); /* ploughing takes a little */
    assert_true(fabs((e.row[row].x - 25000.0) * 9.0 - (e.row[row].z - 25000.0) * 12.0) <
                0.2 * slid);
}

static void test_a_vehicle_that_is_destroyed_in_place_keeps_its_pose(void **state)
{
    (void)state;
    uint32_t row = put("tank", 100.0, (struct vec3){0.0, 0.0, 0.0});
    steps_plane(&f, 0.3, 0.0);
    steps_rows(&f).row[row].heading = HALF_PI;
    steps_rows(&f).row[row].pitch = maths_atan2(0.3, 1.0);
    fixture_run(&f, HZ);
    struct entities e = steps_rows(&f);
    assert_true(rests(row));
    assert_true(fabs(e.row[row].x - 25000.0) < 0.005 && fabs(e.row[row].y - 100.0) < 0.005);
    assert_true(fabs(e.row[row].pitch - maths_atan2(0.3, 1.0)) < 0.001 &&
                fabs(e.row[row].roll) < 0.001);
}

static void test_a_wreck_at_rest_stays_to_the_bit(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 130.0, (struct vec3){20.0, 0.0, 0.0});
    steps_rows(&f).row[row].spin_x = 2.0;
    fixture_run(&f, 20 * HZ);
    struct entities e = steps_rows(&f);
    struct vec3 at = entities_position(&e, row);
    double heading = e.row[row].heading, pitch = e.row[row].pitch, roll = e.row[row].roll;
    uint32_t until = e.row[row].until_tick;
    assert_true(rests(row) && until != 0);
    fixture_run(&f, 5 * HZ);
    e = steps_rows(&f);
    assert_true(e.row[row].x == at.x && e.row[row].y == at.y && e.row[row].z == at.z);
    assert_true(e.row[row].heading == heading && e.row[row].pitch == pitch &&
                e.row[row].roll == roll);
    assert_int_equal(e.row[row].until_tick, until);
}

/* Kinetic and potential energy by the velocity of the position [J/kg]; the wreck does not spin. */
static double energy_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    struct vec3 v = entities_velocity(&e, row);
    return 0.5 * vec3_dot(v, v) + GRAVITY_MPS2 * e.row[row].y;
}

/* v = V tanh(g t / V), fallen by V^2 / g ln cosh(g t / V), with the terminal speed V. */
static void test_the_air_slows_a_wreck_at_any_rate(void **state)
{
    static const char *const rates[] = {"world = { hz = 10.0; };", "world = { hz = 60.0; };"};
    static const uint32_t seconds = 10;
    (void)state;
    for (int n = 0; n < 2; n++) {
        fixture_close(&f);
        fixture_open(&f, rates[n]);
        const struct kind *jeep = steps_kind(&f, "jeep");
        uint32_t row = put("jeep", 1500.0, (struct vec3){0.0, 0.0, 0.0});
        double area = 1.05 * jeep->length_m * jeep->width_m;
        double terminal = sqrt(2.0 * jeep->mass_kg * GRAVITY_MPS2 / (1.225 * area));
        double turns = seconds * GRAVITY_MPS2 / terminal;
        for (uint32_t frame = 0; frame < seconds * f.view.world.params->hz; frame++) {
            double before = energy_of(row);
            fixture_run(&f, 1);
            assert_true(energy_of(row) <= before + 1e-9);
        }
        double fallen = terminal * terminal / GRAVITY_MPS2 * log(cosh(turns));
        assert_true(fabs(-steps_rows(&f).row[row].vy / (terminal * tanh(turns)) - 1.0) < 0.01);
        assert_true(fabs((1500.0 - steps_rows(&f).row[row].y) / fallen - 1.0) < 0.01);
    }
}

/* Of 20 rad/s about the vertical a jet has 15 after four seconds, at any rate of frames. */
static void test_the_air_slows_a_spin(void **state)
{
    static const char *const rates[] = {"world = { hz = 10.0; };", "world = { hz = 60.0; };"};
    double left[2];
    (void)state;
    for (int n = 0; n < 2; n++) {
        fixture_close(&f);
        fixture_open(&f, rates[n]);
        uint32_t row = put("jet", 1500.0, (struct vec3){0.0, 0.0, 0.0});
        steps_rows(&f).row[row].spin_y = 20.0;
        fixture_run(&f, (uint32_t)(4.0 * f.view.world.params->hz));
        left[n] = fabs(steps_rows(&f).row[row].spin_y);
        print_message("jet: 20 -> %.2f rad/s\n", left[n]);
        assert_true(left[n] > 14.0 && left[n] < 16.0);
    }
    assert_true(fabs(left[0] / left[1] - 1.0) < 1e-6);
}

/* A jet that flies on nose first keeps most of its speed; one that turns its side to the wind does
 * not, and a tank keeps more than either. */
static void test_drag_fits_the_kind_and_its_pose(void **state)
{
    static const struct {
        const char *kind;
        double heading_rad, least_mps, most_mps;
    } wrecks[] = {
        {"jet", HALF_PI, 160.0, 199.0}, {"jet", 0.0, 60.0, 140.0}, {"tank", HALF_PI, 180.0, 195.0}};
    (void)state;
    for (size_t n = 0; n < sizeof wrecks / sizeof *wrecks; n++) {
        steps_empty(&f);
        uint32_t row = put(wrecks[n].kind, 1500.0, (struct vec3){200.0, 0.0, 0.0});
        steps_rows(&f).row[row].heading = wrecks[n].heading_rad;
        fixture_run(&f, 3 * HZ);
        double speed = steps_rows(&f).row[row].vx;
        print_message("%s: 200 -> %.1f m/s\n", wrecks[n].kind, speed);
        assert_true(speed > wrecks[n].least_mps && speed < wrecks[n].most_mps);
    }
}

/* A jeep on its springs that an impact stops and wrecks has its corners 3 cm in the ground. In a
 * long frame it was lifted out and fell again, with 0.03 J/kg from nothing. */
static void test_a_wreck_that_is_lifted_out_of_the_ground_gains_no_speed(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "world = { hz = 10.0; };");
    uint32_t row = put("jeep", 100.0002, (struct vec3){0.0, 0.0, 0.0});
    steps_rows(&f).row[row].pitch = 0.0064;
    steps_rows(&f).row[row].roll = -0.0239;
    for (uint32_t frame = 0; frame < 20; frame++) {
        double before = energy_of(row), y = steps_rows(&f).row[row].y;
        fixture_run(&f, 1);
        double lifted = GRAVITY_MPS2 * maths_max(0.0, steps_rows(&f).row[row].y - y);
        assert_true(energy_of(row) <= before + lifted + 1e-4);
    }
    assert_true(rests(row));
}

static void test_a_wreck_does_not_snap_into_the_slope_of_the_ground(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 110.0, (struct vec3){0.0, 0.0, 0.0});
    steps_rows(&f).row[row].pitch = -0.98;
    steps_rows(&f).row[row].roll = 2.36;
    for (uint32_t frame = 0; frame < 20 * HZ && !rests(row); frame++) {
        struct entities e = steps_rows(&f);
        struct quat before = rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll);
        double spin = spin_of(row);
        fixture_run(&f, 1);
        e = steps_rows(&f);
        struct quat after = rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll);
        assert_true(rotation_rate(before, after) < maths_max(spin, spin_of(row)) / HZ + 0.2);
        assert_true(clearance_of(row) > -0.05);
    }
    assert_true(rests(row));
}

static int open_bank(void **state)
{
    *state = &f;
    fixture_open(&f, "earthworks = ( { shape = \"table\"; at = [25010.0, 25000.0];"
                     " length_m = 40.0; width_m = 20.0; height_m = 1.5; edge_m = 0.2; } );");
    return 0;
}

/* A truck that was destroyed beside a bank is in it with one side. It moves away from the bank, so
 * that the ground gives it no impulse, and falls. */
static void test_a_wreck_that_leaves_a_bank_gets_no_deeper(void **state)
{
    (void)state;
    uint32_t row = put("truck", 101.2, (struct vec3){-1.0, -0.5, 0.0});
    steps_rows(&f).row[row].heading = 0.0;
    steps_rows(&f).row[row].x = 25000.4 - 0.5 * steps_kind(&f, "truck")->width_m;
    double before = clearance_of(row);
    assert_true(before < -0.29);
    for (uint32_t frame = 0; frame < 20; frame++) {
        double deep = clearance_of(row);
        fixture_run(&f, 1);
        assert_true(clearance_of(row) > maths_min(deep, -0.02) - 1e-9);
    }
    assert_true(clearance_of(row) > -0.02);
}

/* A crater's rim has risen around it, or its vehicle stood in a bank. Each lift is energy that
 * comes from nothing, and others may lie on it. */
static void test_a_wreck_at_rest_is_lifted_slowly_out_of_the_ground(void **state)
{
    (void)state;
    uint32_t row = put("truck", 99.7, (struct vec3){0.0, 0.0, 0.0});
    for (uint32_t frame = 0; frame < 45 * HZ; frame++) {
        double y = steps_rows(&f).row[row].y;
        fixture_run(&f, 1);
        assert_true(steps_rows(&f).row[row].y - y < 0.0081 / HZ);
    }
    assert_true(rests(row) && clearance_of(row) > -0.02);
}

static void test_overturned_is_overturned(void **state)
{
    static const double rolls[] = {PI, HALF_PI, -HALF_PI};
    (void)state;
    for (int n = 0; n < 3; n++) {
        steps_empty(&f);
        const struct kind *kind = steps_kind(&f, "truck");
        uint32_t row = put("truck", 0.0, (struct vec3){0.0, 0.0, 0.0});
        steps_rows(&f).row[row].roll = rolls[n];
        steps_rows(&f).row[row].y = 0.2 - clearance_of(row);
        fixture_run(&f, 5 * HZ);
        assert_true(rests(row) && fabs(tilt_of(row) - fabs(rolls[n])) < 0.05);
        double height = n == 0 ? kind->height_m : 0.5 * kind->width_m;
        assert_true(fabs(steps_rows(&f).row[row].y - 100.0 - height) < 0.05);
    }
}

static void test_a_jet_ploughs_to_a_halt_within_a_kilometre(void **state)
{
    (void)state;
    uint32_t row = put("jet", 105.0, (struct vec3){200.0, -10.0, 0.0});
    for (uint32_t frame = 0; frame < 60 * HZ && !rests(row); frame++) {
        fixture_run(&f, 1);
        assert_true(clearance_of(row) > -0.6);
    }
    double slid = steps_rows(&f).row[row].x - 25000.0;
    assert_true(rests(row) && slid > 150.0 && slid < 1000.0);
}

static void test_friction_holds_a_wreck_on_a_slope_or_lets_it_go(void **state)
{
    (void)state;
    for (int n = 0; n < 2; n++) {
        double slope = friction_of("tank") * (n == 0 ? 0.93 : 1.1);
        steps_empty(&f);
        steps_plane(&f, slope, 0.0);
        uint32_t row = put("tank", 100.0, (struct vec3){0.0, 0.0, 0.0});
        steps_rows(&f).row[row].heading = HALF_PI;
        steps_rows(&f).row[row].pitch = maths_atan2(slope, 1.0);
        fixture_run(&f, 2 * HZ);
        double from = steps_rows(&f).row[row].x;
        assert_true(fabs(from - 25000.0) < 0.01 || n == 1);
        fixture_run(&f, 8 * HZ);
        double moved = from - steps_rows(&f).row[row].x;
        assert_true(n == 0 ? moved == 0.0 && rests(row) : moved > 5.0);
    }
}

/* A wreck that begins in the ground, by so little that it is not lifted out, slides as well. */
static void test_a_wreck_in_steep_ground_is_not_stuck(void **state)
{
    static const double depths_m[] = {0.0025, 0.003, 0.004, 0.008};
    (void)state;
    for (uint32_t n = 0; n < sizeof depths_m / sizeof *depths_m; n++) {
        double slope = 1.2 * friction_of("tank"), normal_y = 1.0 / sqrt(1.0 + slope * slope);
        steps_empty(&f);
        steps_plane(&f, slope, 0.0);
        uint32_t row = put("tank", 100.0 - depths_m[n] / normal_y, (struct vec3){0.0, 0.0, 0.0});
        steps_rows(&f).row[row].heading = HALF_PI;
        steps_rows(&f).row[row].pitch = maths_atan2(slope, 1.0);
        fixture_run(&f, 5 * HZ);
        assert_true(25000.0 - steps_rows(&f).row[row].x > 2.0);
    }
}

static void test_a_crater_and_a_push_wake_a_wreck(void **state)
{
    (void)state;
    uint32_t row = put("tank", 100.0, (struct vec3){0.0, 0.0, 0.0});
    fixture_run(&f, 2 * HZ);
    assert_true(rests(row));
    fixture_put(&f, (struct fixture_entity){.kind = "bomb",
                                            .at = {25006.0, 120.0, 25000.0},
                                            .velocity = {0.0, -400.0, 0.0}});
    fixture_run(&f, 5 * HZ);
    assert_int_equal(fixture_state(&f).head->crater_count, 1);
    assert_true(rests(row) && clearance_of(row) > -0.02 && tilt_of(row) > 0.03);
    struct vec3 at = {steps_rows(&f).row[row].x, 0.0, steps_rows(&f).row[row].z};
    steps_rows(&f).row[row].vz = 8.0;
    fixture_run(&f, 5 * HZ);
    assert_true(rests(row) && steps_rows(&f).row[row].z > at.z + 1.0);
}

static void test_a_light_push_does_not_wake_a_wreck(void **state)
{
    static const double speeds[] = {0.5e-3, 2e-3};
    (void)state;
    for (int n = 0; n < 2; n++) {
        steps_empty(&f);
        uint32_t row = put("tank", 100.0, (struct vec3){0.0, 0.0, 0.0});
        fixture_run(&f, 2 * HZ);
        double from = steps_rows(&f).row[row].z;
        steps_rows(&f).row[row].vz = speeds[n];
        fixture_run(&f, 1);
        assert_true(rests(row) && (steps_rows(&f).row[row].z == from) == (n == 0));
    }
}

/* --- breaking up ------------------------------------------------------------------------------*/

static bool is_broken(uint32_t row)
{
    return steps_rows(&f).row[row].flags & ENTITY_FLAG_BROKEN;
}

static struct vec3 fallen; /* the velocity before the frame in which it broke */

static uint32_t drop(const char *kind, struct vec3 velocity)
{
    steps_empty(&f);
    uint32_t row = put(kind, 0.0, velocity);
    steps_rows(&f).row[row].y = 1.0 - clearance_of(row);
    for (uint32_t frame = 0; frame < HZ && !is_broken(row); frame++) {
        struct entities e = steps_rows(&f);
        fallen = entities_velocity(&e, row);
        fixture_run(&f, 1);
    }
    return row;
}

static void test_an_aircraft_that_strikes_the_ground_hard_breaks_up(void **state)
{
    (void)state;
    uint32_t row = drop("jet", (struct vec3){200.0, -40.0, 0.0});
    assert_true(is_broken(row));
    assert_int_equal(steps_rows(&f).row[row].trigger, 0);
    assert_int_equal(steps_rows(&f).row[row].changed_tick, fixture_state(&f).head->tick);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    const struct event_collision *hit = &fixture_event(&f, EVENT_COLLISION, 0)->collision;
    assert_int_equal(hit->a.id, row + 1);
    assert_true(hit->b.id == 0 && hit->b.fixed == 1 && hit->response == RESPONSE_DESTROYED);
    assert_true(fabs((double)hit->closing_mps - 40.0) < 2.0);
    /* What the wreck loses is what the ground has given it: breaking itself takes no momentum. */
    struct entities e = steps_rows(&f);
    struct vec3 change = vec3_sub(entities_velocity(&e, row), fallen);
    double mass = steps_kind(&f, "jet")->mass_kg;
    assert_true(fabs((double)hit->impulse_ns / mass - vec3_length(change)) < 0.01);
    fixture_run(&f, 60 * HZ);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1); /* it breaks up once */
}

static void test_only_a_hard_impact_breaks_an_airframe_and_no_tank(void **state)
{
    (void)state;
    assert_false(is_broken(drop("jet", (struct vec3){60.0, -10.0, 0.0})));
    assert_false(is_broken(drop("helicopter", (struct vec3){0.0, -13.0, 0.0})));
    assert_true(is_broken(drop("helicopter", (struct vec3){0.0, -25.0, 0.0})));
    assert_false(is_broken(drop("tank", (struct vec3){0.0, -40.0, 0.0})));
}

static void test_pieces_stop_sooner_and_gain_no_energy(void **state)
{
    double slid[2];
    (void)state;
    for (int n = 0; n < 2; n++) {
        steps_empty(&f);
        uint32_t row = put("jet", 0.0, (struct vec3){150.0, 0.0, 0.0});
        steps_rows(&f).row[row].flags = n == 0 ? 0 : ENTITY_FLAG_BROKEN;
        steps_rows(&f).row[row].y = 0.05 - clearance_of(row);
        double before = energy_of(row);
        for (uint32_t frame = 0; frame < 30 * HZ && !rests(row); frame++) {
            fixture_run(&f, 1);
            assert_true(n == 0 || spin_of(row) > 1e-6 || energy_of(row) <= before + 1e-6);
            before = energy_of(row);
        }
        assert_true(rests(row));
        slid[n] = steps_rows(&f).row[row].x - 25000.0;
    }
    /* ln(1 + b v2 / mu) / (2 b g), but for what tumbling takes */
    double b = 1.25e-3, mu = friction_of("jet");
    double way = log(1.0 + b * 150.0 * 150.0 / mu) / (2.0 * b * GRAVITY_MPS2);
    assert_true(slid[1] < 0.6 * slid[0] && slid[1] > 0.5 * way && slid[1] < 1.3 * way);
}

static void test_a_ship_drifts_on_the_water_and_sinks(void **state)
{
    (void)state;
    steps_cover(&f, COVER_LAKE, 0.0, 0.0, 50000.0, 50000.0);
    uint32_t row = put("ship", 100.0, (struct vec3){6.0, 0.0, 0.0});
    steps_rows(&f).row[row].spin_y = 0.2;
    fixture_run(&f, 120 * HZ);
    struct entities e = steps_rows(&f);
    assert_true(rests(row) && e.row[row].y < 99.0 && e.row[row].pitch == 0.0 &&
                e.row[row].roll == 0.0);
    assert_true(fabs(e.row[row].x - 25000.0 - 36.0 / (2.0 * 0.03 * GRAVITY_MPS2)) < 1.0);
    assert_true(e.row[row].until_tick != 0);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, fixture_teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_a_wreck_slides_to_rest_by_friction),
        TEST(test_a_vehicle_that_is_destroyed_in_place_keeps_its_pose),
        TEST(test_a_wreck_at_rest_stays_to_the_bit),
        TEST(test_the_air_slows_a_wreck_at_any_rate),
        TEST(test_drag_fits_the_kind_and_its_pose),
        TEST(test_the_air_slows_a_spin),
        TEST(test_a_wreck_that_is_lifted_out_of_the_ground_gains_no_speed),
        TEST(test_a_wreck_does_not_snap_into_the_slope_of_the_ground),
        cmocka_unit_test_setup_teardown(test_a_wreck_that_leaves_a_bank_gets_no_deeper, open_bank,
                                        fixture_teardown),
        TEST(test_a_wreck_at_rest_is_lifted_slowly_out_of_the_ground),
        TEST(test_overturned_is_overturned),
        TEST(test_a_jet_ploughs_to_a_halt_within_a_kilometre),
        TEST(test_friction_holds_a_wreck_on_a_slope_or_lets_it_go),
        TEST(test_a_wreck_in_steep_ground_is_not_stuck),
        TEST(test_a_crater_and_a_push_wake_a_wreck),
        TEST(test_a_light_push_does_not_wake_a_wreck),
        TEST(test_an_aircraft_that_strikes_the_ground_hard_breaks_up),
        TEST(test_only_a_hard_impact_breaks_an_airframe_and_no_tank),
        TEST(test_pieces_stop_sooner_and_gain_no_energy),
        TEST(test_a_ship_drifts_on_the_water_and_sinks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
