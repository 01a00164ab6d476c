/* Wheels and tyres of a jeep that stands on level ground, and on a step. */
#include "mover/motion/suspension.h"

#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

static struct fixture f;
static struct step_context step;
static struct serial_context serial;
static struct suspension suspension;

static int open_world(void **state)
{
    *state = &f;
    fixture_open(&f, "earthworks = ( { shape = \"table\"; at = [25050.0, 25000.0]; length_m = 60.0;"
                     " width_m = 40.0; height_m = 0.2; edge_m = 0.05; } );");
    return 0;
}

static double rises_mps; /* of the body */

/* Returns the load over the weight of a jeep that heads east there, so high over its rest. */
static double load_at(double x, double height_m, bool uneven)
{
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = "jeep",
                                                .at = {x, FIXTURE_GROUND_M + height_m, 25000.0},
                                                .heading_rad = HALF_PI});
    steps_serial_context(&f, &step, &serial);
    struct rigid_body body = rigid_body_take(&step, row);
    struct mat3 turn = rotation_matrix(body.turn);
    body.velocity.y = rises_mps;
    suspension_of(steps_kind(&f, "jeep"), true, &suspension);
    return suspension_load(&suspension, &step, &body, &turn, uneven) /
           (GRAVITY_MPS2 * body.inertia.mass_kg);
}

static void test_springs_carry_the_weight_at_rest(void **state)
{
    (void)state;
    assert_true(fabs(load_at(25000.0, 0.0, false) - 1.0) < 1e-9);
    assert_true(fabs(load_at(25000.0, 0.0, true) - 1.0) < 1e-9);
    assert_true(fabs(load_at(25000.0, 0.5 * suspension.sag_m, false) - 0.5) < 1e-9);
    assert_true(load_at(25000.0, 1.01 * suspension.sag_m, false) == 0.0);
}

static void test_bump_stops_are_ten_times_as_stiff_and_give_nothing_back(void **state)
{
    (void)state;
    load_at(25000.0, 0.0, false);
    double travel = suspension.most_m - suspension.sag_m;
    double at_stop = load_at(25000.0, -travel, false);
    rises_mps = -1e-12;
    double beyond = load_at(25000.0, -travel - 0.01, false);
    double far = load_at(25000.0, -travel - 0.5, false);
    rises_mps = 1e-12;
    double back = load_at(25000.0, -travel - 0.01, false);
    double far_back = load_at(25000.0, -travel - 0.5, false);
    rises_mps = 0.0;
    assert_true(fabs(at_stop - suspension.most_m / suspension.sag_m) < 1e-9);
    assert_true(fabs(beyond - at_stop - 11.0 * 0.01 / suspension.sag_m) < 1e-9);
    assert_true(fabs(far - at_stop - 11.0 * 0.15 / suspension.sag_m) < 1e-9);
    assert_true(fabs(back - at_stop) < 1e-9 && fabs(far_back - at_stop) < 1e-9);
}

/* The west end of the table is at 25030, because its width lies east and west. */
static void test_a_wheel_touches_an_edge_before_it_is_over_it(void **state)
{
    (void)state;
    load_at(25000.0, 0.0, true);
    double front = suspension.wheel[0].place.x;
    for (double before = 0.5; before > 0.0; before -= 0.05) {
        load_at(25030.0 - front - before, 0.0, true);
        const struct wheel *wheel = &suspension.wheel[0];
        bool touches = before < 0.3; /* its radius is 0.34 m */
        assert_true(before > 0.3 || wheel->squeeze_m > suspension.sag_m);
        assert_true(touches || fabs(wheel->squeeze_m - suspension.sag_m) < 0.05);
    }
}

/* The jeep climbs 0.33 m. In front of a higher table its wheel keeps its load. */
static void test_a_wall_lifts_no_wheel(void **state)
{
    (void)state;
    for (double height = 0.25; height < 0.5; height += 0.06) {
        char work[200];
        snprintf(work, sizeof work,
                 "earthworks = ( { shape = \"table\"; at = [25050.0, 25000.0]; length_m = 60.0;"
                 " width_m = 40.0; height_m = %.2f; edge_m = 0.065; } );",
                 height);
        fixture_close(&f);
        fixture_open(&f, work);
        load_at(25000.0, 0.0, true);
        load_at(25030.0 - suspension.wheel[0].place.x - 0.2, 0.0, true);
        bool lifted = suspension.wheel[0].squeeze_m > suspension.sag_m + 0.02;
        assert_true(lifted == (height < 0.33));
    }
}

static void test_grip_is_the_sum_of_the_wheels(void **state)
{
    (void)state;
    double load = load_at(25000.0, 0.0, false);
    for (uint32_t i = 0; i < suspension.count; i++)
        suspension.wheel[i].friction = i & 1 ? 0.2 : 0.6;
    double weight = GRAVITY_MPS2 * steps_kind(&f, "jeep")->mass_kg;
    assert_true(fabs(suspension_grip(&suspension) - 0.4 * load * weight) < 1e-6);
}

/* The stiffness against heave [N/m] and against pitch [N m/rad]. */
static double stiffness(const char *kind, bool uneven, double *pitch)
{
    double heave = 0.0;
    suspension_of(steps_kind(&f, kind), uneven, &suspension);
    *pitch = 0.0;
    for (uint32_t i = 0; i < suspension.count; i++) {
        double x = suspension.wheel[i].place.x;
        heave += suspension.spring_npm;
        *pitch += suspension.spring_npm * x * x;
    }
    return heave;
}

static void test_three_wheels_of_a_track_are_as_stiff_as_all(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "missile-carrier", "truck", "jeep"};
    (void)state;
    for (int n = 0; n < 5; n++) {
        double pitch, pitch_even, heave = stiffness(kinds[n], true, &pitch);
        uint32_t all = suspension.count;
        double front = suspension.front_m, heave_even = stiffness(kinds[n], false, &pitch_even);
        assert_true(fabs(heave_even / heave - 1.0) < 1e-12);
        assert_true(fabs(pitch_even / pitch - 1.0) < 1e-12);
        assert_true(suspension.front_m == front);
        assert_int_equal(suspension.count, n < 3 ? 6 : all);
    }
}

int main(void)
{
#define T(name) cmocka_unit_test_setup_teardown(name, open_world, fixture_teardown)
    const struct CMUnitTest tests[] = {
        T(test_springs_carry_the_weight_at_rest),
        T(test_bump_stops_are_ten_times_as_stiff_and_give_nothing_back),
        T(test_a_wall_lifts_no_wheel),
        T(test_a_wheel_touches_an_edge_before_it_is_over_it),
        T(test_grip_is_the_sum_of_the_wheels),
        T(test_three_wheels_of_a_track_are_as_stiff_as_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
