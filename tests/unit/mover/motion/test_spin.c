/* Spin, the angular velocity that a collision gives: tyres and water brake it, and in the air it
 * continues about the centre of mass. */
#include "tests/support/steps.h"
#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ    60.0
#define SCRUB 0.7 /* of its weight, what tyres hold against a turn */
#define PILOT 1.5 /* [rad/s2] what a pilot takes off a spin */

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static uint32_t put(const char *kind, double y, enum behaviour behaviour, struct vec3 velocity)
{
    return fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                   .at = {25000.0, y, 25000.0},
                                                   .velocity = velocity,
                                                   .heading_rad = 1.0,
                                                   .behaviour = behaviour});
}

static void set_spin(uint32_t row, double x, double y, double z)
{
    struct entities e = steps_rows(&f);
    e.row[row].spin_x = x;
    e.row[row].spin_y = y;
    e.row[row].spin_z = z;
}

static double spin_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return vec3_length((struct vec3){e.row[row].spin_x, e.row[row].spin_y, e.row[row].spin_z});
}

static double tyre_brake(const char *kind)
{
    return SCRUB * GRAVITY_MPS2 / (0.25 * steps_kind(&f, kind)->length_m);
}

/* --- on the ground and on the water ------------------------------------------------------------*/

static void test_a_positive_spin_lowers_the_heading_and_the_tyres_end_it(void **state)
{
    double brake = tyre_brake("tank");
    (void)state;
    for (int n = 0; n < 2; n++) {
        double sign = n & 1 ? -1.0 : 1.0;
        fixture_close(&f);
        fixture_open(&f, "");
        uint32_t row = put("tank", 100.0, BEHAVIOUR_HOLD, (struct vec3){0.0, 0.0, 0.0});
        set_spin(row, 0.0, sign * 0.9, 0.0);
        fixture_run(&f, 1);
        assert_true(fabs(steps_rows(&f).row[row].heading - (1.0 - sign * 0.9 / HZ)) < 1e-12);
        assert_true(fabs(sign * steps_rows(&f).row[row].spin_y - (0.9 - brake / HZ)) < 1e-12);
        fixture_run(&f, (uint32_t)(0.9 / brake * HZ) + 1);
        assert_true(steps_rows(&f).row[row].spin_y == 0.0);
        /* w squared over 2 a, within a frame's turn. */
        double turned = sign * (1.0 - steps_rows(&f).row[row].heading);
        assert_true(fabs(turned - 0.9 * 0.9 / (2.0 * brake)) < 0.9 / HZ);
        double heading = steps_rows(&f).row[row].heading;
        fixture_run(&f, 30);
        assert_true(steps_rows(&f).row[row].heading == heading);
    }
}

static void test_what_holds_its_course_does_not_tumble(void **state)
{
    (void)state;
    uint32_t tank = put("tank", 100.0, BEHAVIOUR_HOLD, (struct vec3){0.0, 0.0, 0.0});
    set_spin(tank, 3.0, 0.0, -2.0);
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_true(spin_of(tank) == 0.0 && e.row[tank].heading == 1.0);
    assert_true(e.row[tank].pitch == 0.0 && e.row[tank].roll == 0.0 && e.row[tank].y == 100.0);
}

static void test_water_brakes_a_turn_more_softly(void **state)
{
    (void)state;
    steps_kind(&f, "ship")->length_m = steps_kind(&f, "tank")->length_m;
    steps_cover(&f, COVER_LAKE, 29000.0, 0.0, 50000.0, 50000.0);
    uint32_t tank = put("tank", 100.0, BEHAVIOUR_DRIVEN, (struct vec3){0.0, 0.0, 0.0});
    uint32_t ship = put("ship", 100.0, BEHAVIOUR_DRIVEN, (struct vec3){0.0, 0.0, 0.0});
    steps_rows(&f).row[ship].x = 40000.0;
    set_spin(tank, 0.0, 0.5, 0.0);
    set_spin(ship, 0.0, 0.5, 0.0);
    fixture_run(&f, 6);
    assert_true(spin_of(ship) > spin_of(tank) && spin_of(ship) < 0.5);
    fixture_run(&f, 60);
    assert_true(spin_of(ship) == 0.0);
    assert_true(steps_rows(&f).row[ship].heading < steps_rows(&f).row[tank].heading);
    assert_true(steps_rows(&f).row[ship].pitch == 0.0 && steps_rows(&f).row[ship].roll == 0.0);
}

/* --- in the air --------------------------------------------------------------------------------*/

/* Angular momentum about the body's own middle. */
static struct vec3 momentum_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    const struct mass_properties inertia = mass_properties_of(&f.view.world.kinds[e.row[row].kind]);
    struct mat3 turn =
        rotation_matrix(rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll));
    struct vec3 spin = rotation_back(
        &turn, (struct vec3){e.row[row].spin_x, e.row[row].spin_y, e.row[row].spin_z});
    return rotation_apply(&turn, (struct vec3){inertia.moment.x * spin.x, inertia.moment.y * spin.y,
                                               inertia.moment.z * spin.z});
}

static void test_a_body_on_hold_keeps_its_momentum_and_energy(void **state)
{
    (void)state;
    uint32_t row = put("jet", 900.0, BEHAVIOUR_HOLD, (struct vec3){120.0, 2.0, -40.0});
    struct entities e = steps_rows(&f);
    struct vec3 from = entities_position(&e, row);
    set_spin(row, 1.7, -0.4, 0.9);
    struct vec3 momentum = momentum_of(row), spin = {1.7, -0.4, 0.9};
    double energy = vec3_dot(momentum, spin);
    for (int frame = 1; frame <= 300; frame++) {
        fixture_run(&f, 1);
        e = steps_rows(&f);
        struct vec3 off = vec3_sub(momentum_of(row), momentum);
        assert_true(vec3_length(off) < 1e-9 * vec3_length(momentum));
        spin = (struct vec3){e.row[row].spin_x, e.row[row].spin_y, e.row[row].spin_z};
        assert_true(fabs(vec3_dot(momentum_of(row), spin) - energy) < 1e-9 * energy);
        assert_true(e.row[row].vx == 120.0 && e.row[row].vy == 2.0 && e.row[row].vz == -40.0);
        struct vec3 way = vec3_scale((struct vec3){120.0, 2.0, -40.0}, frame / HZ);
        off = vec3_sub(entities_position(&e, row), vec3_add(from, way));
        assert_true(vec3_length(off) < 1e-8);
    }
}

static void test_spin_in_the_air_turns_by_its_rate(void **state)
{
    (void)state;
    uint32_t row = put("jet", 900.0, BEHAVIOUR_HOLD, (struct vec3){0.0, 0.0, 0.0});
    set_spin(row, 0.0, -0.8, 0.0);
    fixture_run(&f, 60);
    assert_true(fabs(steps_rows(&f).row[row].heading - 1.8) < 1e-9);
    assert_true(steps_rows(&f).row[row].x == 25000.0);
    /* About its own nose: it rolls, right side down. */
    set_spin(row, 0.5 * maths_sin(1.8), 0.0, -0.5 * maths_cos(1.8));
    fixture_run(&f, 60);
    assert_true(fabs(steps_rows(&f).row[row].roll - 0.5) < 1e-9);
    assert_true(fabs(steps_rows(&f).row[row].heading - 1.8) < 1e-9);
}

static void test_a_pilot_gets_his_aircraft_out_of_a_spin(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 400.0, BEHAVIOUR_DRIVEN, (struct vec3){0.0, 0.0, 0.0});
    set_spin(row, 0.9, 1.2, 0.0);
    double before = spin_of(row);
    fixture_run(&f, 1);
    /* Less what its axes take over as they turn. */
    assert_true(fabs(spin_of(row) - (before - PILOT / HZ)) < 0.01);
    assert_true(fabs(steps_rows(&f).row[row].heading - 1.0) > 0.01);
    fixture_run(&f, (uint32_t)(2.0 * before / PILOT * HZ) + 1);
    assert_true(spin_of(row) == 0.0);
    fixture_run(&f, 600);
    struct entities e = steps_rows(&f);
    assert_true(fabs(e.row[row].roll) < 0.1 && fabs(e.row[row].pitch) < 0.3);
}

/* He leans and turns the aircraft under its spin. That adds no energy of rotation. */
static void test_steering_adds_no_energy_to_a_spin(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 900.0, BEHAVIOUR_DRIVEN, (struct vec3){20.0, 0.0, 0.0});
    set_spin(row, -1.2, -5.9, -1.6);
    double last = INFINITY;
    for (int frame = 0; frame < 120; frame++) {
        steps_drive(&f, row, 1.0, frame < 60 ? 1.0 : -1.0, 0.0);
        struct entities e = steps_rows(&f);
        struct vec3 spin = {e.row[row].spin_x, e.row[row].spin_y, e.row[row].spin_z};
        double energy = vec3_dot(momentum_of(row), spin);
        assert_true(energy < last);
        last = energy;
    }
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_positive_spin_lowers_the_heading_and_the_tyres_end_it),
        TEST(test_what_holds_its_course_does_not_tumble),
        TEST(test_water_brakes_a_turn_more_softly),
        TEST(test_a_body_on_hold_keeps_its_momentum_and_energy),
        TEST(test_spin_in_the_air_turns_by_its_rate),
        TEST(test_a_pilot_gets_his_aircraft_out_of_a_spin),
        TEST(test_steering_adds_no_energy_to_a_spin),
    };
    return cmocka_run_group_tests_name("spin", tests, NULL, NULL);
}
