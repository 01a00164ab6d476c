/* The shell of a tank before a wall, at the edge of one, and over level ground. */
#include "mover/motion/chassis_shell.h"

#include "tests/support/steps.h"
#include "world/terrain/terrain.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define DT_S (1.0 / 240.0)

static struct fixture f;
static struct step_context step;
static struct serial_context serial;
static struct suspension suspension;
static struct chassis_shell shell;

/* A wall of 2.5 m across the way to the east: its foot is at x = 25030. */
static int open_world(void **state)
{
    *state = &f;
    fixture_open(&f, "earthworks = ( { shape = \"table\"; at = [25050.0, 25000.0]; length_m = 60.0;"
                     " width_m = 40.0; height_m = 2.5; edge_m = 0.33; } );");
    return 0;
}

/* Takes a vehicle that heads east, its front so far before the wall, and finds its shell. */
static struct rigid_body body_before(const char *kind, double gap_m, double height_m)
{
    double front = 0.5 * steps_kind(&f, kind)->length_m;
    const struct fixture_entity entity = {
        .kind = kind,
        .at = {25030.0 - front - gap_m, FIXTURE_GROUND_M + height_m, 25000.0},
        .heading_rad = HALF_PI};
    uint32_t row = fixture_put(&f, entity);
    steps_serial_context(&f, &step, &serial);
    suspension_of(steps_kind(&f, kind), true, &suspension);
    chassis_shell_of(steps_kind(&f, kind), &suspension, &shell);
    return rigid_body_take(&step, row);
}

static struct chassis_shell_push press(const char *kind, struct rigid_body *body)
{
    return chassis_shell_press(&shell, &f.view.world.terrain, NULL, steps_kind(&f, kind), body,
                               DT_S);
}

static void test_a_wall_stops_it_within_a_sub_step(void **state)
{
    (void)state;
    for (double mps = 1.0; mps <= 60.0; mps *= 1.7) {
        struct rigid_body body = body_before("tank", 0.02, 0.0);
        double nose = 2.5 / 0.33; /* slope of the wall */
        body.velocity = (struct vec3){mps, 0.0, 0.0};
        press("tank", &body);
        double most = 0.02 + suspension.reach_m / nose + 0.02; /* to its face at the nose */
        assert_true(body.velocity.x * DT_S <= most);
    }
}

static void test_what_hits_squarely_does_not_turn(void **state)
{
    (void)state;
    struct rigid_body body = body_before("tank", 0.02, 0.0);
    body.velocity = (struct vec3){60.0, 0.0, 0.0};
    assert_true(press("tank", &body).impulse_ns > 0.0);
    assert_true(fabs(body.spin.y) < 1e-9 && fabs(body.velocity.z) < 1e-9);
}

static void test_it_gains_no_energy(void **state)
{
    (void)state;
    for (int n = 0; n < 40; n++) {
        struct rigid_body body = body_before("jeep", 0.05, 0.02 * n);
        body.velocity = (struct vec3){20.0, -0.2 * n, 0.1 * n};
        body.spin = (struct vec3){0.05 * n, 0.02 * n, -0.1 * n};
        double before = rigid_body_energy(&body);
        press("jeep", &body);
        assert_true(rigid_body_energy(&body) <= before * (1.0 + 1e-12));
    }
}

static void test_over_level_ground_nothing_touches(void **state)
{
    (void)state;
    struct rigid_body body = body_before("tank", 20.0, 0.0);
    body.velocity = (struct vec3){16.0, 0.0, 0.0};
    assert_true(press("tank", &body).impulse_ns == 0.0 && body.velocity.x == 16.0);
}

/* Wheels carry the points before them up, so that an edge that they roll onto is no wall. */
static void test_points_rise_with_their_wheels(void **state)
{
    (void)state;
    body_before("jeep", 20.0, 0.0);
    assert_int_equal(shell.count, CHASSIS_SHELL_POINTS);
    for (uint32_t i = 0; i < suspension.count; i++)
        suspension.wheel[i].squeeze_m = suspension.sag_m + 0.02 * i;
    chassis_shell_follow(&shell, &suspension);
    for (uint32_t n = VEHICLE_SHELL_POINTS; n < shell.count; n++) {
        uint32_t wheel = (shell.point[n].x > 0.0 ? 0u : 2u) + (shell.point[n].z > 0.0 ? 1u : 0u);
        assert_true(fabs(shell.point[n].y - suspension.reach_m - 0.02 * wheel) < 1e-12);
    }
    body_before("tank", 20.0, 0.0);
    assert_int_equal(shell.count, VEHICLE_SHELL_POINTS);
}

/* A crater that changes the ground may wedge a body between its walls: it gets out upwards. */
static void test_new_ground_over_it_lifts_it_out(void **state)
{
    (void)state;
    struct rigid_body body = body_before("tank", -0.2, 0.0);
    body.velocity.y = -GRAVITY_MPS2 * DT_S; /* its weight */
    struct chassis_shell_push push = press("tank", &body);
    assert_true(push.velocity_mps.x < 0.0);
    assert_true(push.velocity_mps.y > 0.5 * fabs(push.velocity_mps.x));
}

/* A point that leaves the ground bears nothing; deep in it, it is pushed out, and slowly. */
static void test_a_deep_point_that_bears_nothing_is_pushed_out(void **state)
{
    (void)state;
    for (double deep = 0.015; deep < 0.5; deep *= 2.0) {
        struct rigid_body body = body_before("tank", 20.0, 0.0);
        body.centre.y -= steps_kind(&f, "tank")->travel_m + deep;
        body.velocity.y = 0.1;
        struct chassis_shell_push push = press("tank", &body);
        assert_true(push.acts && push.impulse_ns == 0.0);
        assert_true(push.velocity_mps.y > 0.2 && push.velocity_mps.y < 0.6);
    }
}

/* Where a spring moves a wheel into a wall, the wall stops the wheel, and hardly pushes the body.
 */
static void test_a_wheel_in_the_ground_hardly_pushes_the_body(void **state)
{
    (void)state;
    struct rigid_body body = body_before("jeep", 0.0, 0.0);
    chassis_shell_follow(&shell, &suspension);
    for (uint32_t n = 0; n < VEHICLE_SHELL_POINTS; n++) /* only the wheels can touch it */
        shell.point[n].x = 0.0;
    for (uint32_t n = VEHICLE_SHELL_POINTS; n < shell.count; n++)
        shell.point[n].x = 0.5 * steps_kind(&f, "jeep")->length_m + 0.1;
    body.velocity.x = 3.0;
    struct chassis_shell_push push = press("jeep", &body);
    assert_true(push.impulse_ns > 0.0);
    assert_true(body.velocity.x < 2.9);
    assert_true(vec3_length(push.velocity_mps) < 0.15);
}

int main(void)
{
#define T(name) cmocka_unit_test_setup_teardown(name, open_world, fixture_teardown)
    const struct CMUnitTest tests[] = {
        T(test_a_wall_stops_it_within_a_sub_step),
        T(test_what_hits_squarely_does_not_turn),
        T(test_it_gains_no_energy),
        T(test_over_level_ground_nothing_touches),
        T(test_points_rise_with_their_wheels),
        T(test_new_ground_over_it_lifts_it_out),
        T(test_a_deep_point_that_bears_nothing_is_pushed_out),
        T(test_a_wheel_in_the_ground_hardly_pushes_the_body),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
