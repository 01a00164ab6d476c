/* Contacts of a box with level ground, in one sub-step. */
#include "mover/motion/ground_contacts.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define DT_S     0.01
#define UNSOLVED 1e-3 /* share of the closing speed that the sweeps may leave */

static struct fixture f;
static struct step_context context;
static struct serial_context serial;
static struct ground_contacts contacts;
static struct body_points points;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    steps_serial_context(&f, &context, &serial);
    return 0;
}

/* A truck that stands this high over the ground. */
static struct rigid_body truck(double height, struct vec3 velocity)
{
    const struct kind *kind = steps_kind(&f, "truck");
    struct rigid_body body = {.inertia = mass_properties_of(kind),
                              .turn = rotation_of(HALF_PI, 0.0, 0.0),
                              .velocity = velocity};
    body.centre =
        (struct vec3){25000.0, FIXTURE_GROUND_M + height + body.inertia.centre_m, 25000.0};
    body_points_of(&f.view.world, fixture_kind(&f, "truck"), &points);
    ground_contacts_begin(&contacts, kind);
    ground_contacts_find(&contacts, &context, &points, &body, DT_S);
    return body;
}

static void test_points_that_can_reach_the_ground_are_found(void **state)
{
    (void)state;
    truck(5.0, (struct vec3){0.0, -10.0, 0.0});
    assert_int_equal(contacts.count, 0);
    truck(0.05, (struct vec3){0.0, -10.0, 0.0});
    assert_int_equal(contacts.count, 4);
    assert_true(fabs(contacts.contact[0].gap_m - 0.05) < 1e-9);
    assert_true(ground_contacts_depth(&contacts) == 0.0);
    truck(-0.3, (struct vec3){0.0, 0.0, 0.0});
    assert_true(fabs(ground_contacts_depth(&contacts) - 0.3) < 1e-9);
}

static void test_a_point_arrives_on_the_ground_and_not_under_it(void **state)
{
    (void)state;
    struct rigid_body body = truck(0.05, (struct vec3){0.0, -20.0, 0.0}); /* too hard to bounce */
    double impulse = ground_contacts_solve(&contacts, &body, DT_S);
    assert_true(fabs(body.velocity.y + 0.05 / DT_S) < UNSOLVED * 20.0);
    assert_true(fabs(impulse / body.inertia.mass_kg - (20.0 - 5.0)) < UNSOLVED * 20.0);
    double taken = ground_contacts_taken(&contacts, &body) / body.inertia.mass_kg;
    assert_true(fabs(taken - 0.5 * (20.0 * 20.0 - 5.0 * 5.0)) < UNSOLVED * 400.0);
    body = truck(0.5, (struct vec3){0.0, -20.0, 0.0}); /* does not arrive */
    assert_true(ground_contacts_solve(&contacts, &body, DT_S) == 0.0 && body.velocity.y == -20.0);
    assert_true(ground_contacts_taken(&contacts, &body) == 0.0);
}

static void test_restitution_falls_with_the_closing_speed(void **state)
{
    static const double closing[] = {0.4, 1.0, 5.0, 9.0, 11.0};
    double before = 1.0;
    (void)state;
    for (int n = 0; n < 5; n++) {
        struct rigid_body body = truck(0.0, (struct vec3){0.0, -closing[n], 0.0});
        ground_contacts_solve(&contacts, &body, DT_S);
        double share = body.velocity.y / closing[n];
        assert_true(share > -UNSOLVED && share < 0.2 + UNSOLVED);
        assert_true(n == 0 || n == 4 ? share < UNSOLVED : share > 0.01 && share < before);
        before = n == 0 ? 1.0 : share;
    }
}

static void test_friction_is_within_its_cone(void **state)
{
    (void)state;
    struct rigid_body body = truck(0.0, (struct vec3){9.0, -1.0, 0.0});
    double most = sqrt(0.7 * steps_kind(&f, "truck")->friction) *
                  ground_contacts_solve(&contacts, &body, DT_S);
    double lost = body.inertia.mass_kg * (9.0 - body.velocity.x);
    assert_true(lost > 0.5 * most && lost <= most * (1.0 + 1e-9));
    body = truck(0.0, (struct vec3){0.05, -1.0, 0.0}); /* it ends all slip */
    ground_contacts_solve(&contacts, &body, DT_S);
    assert_true(fabs(body.velocity.x + vec3_cross(body.spin, contacts.contact[0].arm).x) <
                5.0 * UNSOLVED);
}

static void test_ploughing_slows_along_the_ground(void **state)
{
    (void)state;
    struct rigid_body body = truck(0.0, (struct vec3){100.0, -1.0, 0.0});
    double impulse = ground_contacts_solve(&contacts, &body, DT_S);
    double before = body.velocity.x, up = body.velocity.y;
    ground_contacts_plough(&contacts, &body, impulse);
    double keeps = 1.0 / (1.0 + 2.5e-4 * before * impulse / body.inertia.mass_kg);
    assert_true(fabs(body.velocity.x - before * keeps) < 1e-3 * before && keeps < 0.99);
    assert_true(fabs(body.velocity.y - up) < 1e-9);
}

static void test_soil_resists_rolling_and_turns_nothing_round(void **state)
{
    (void)state;
    struct rigid_body body = truck(0.0, (struct vec3){0.0, -1.0, 0.0});
    ground_contacts_solve(&contacts, &body, DT_S);
    body.spin = (struct vec3){0.0, 0.0, 3.0};
    ground_contacts_roll(&contacts, &body);
    assert_true(body.spin.x == 0.0 && body.spin.y == 0.0);
    assert_true(body.spin.z > 2.0 && body.spin.z < 2.99);
    body.spin = (struct vec3){0.0, 0.01, 0.0};
    ground_contacts_roll(&contacts, &body);
    assert_true(vec3_length(body.spin) == 0.0);
}

static void test_a_point_is_pushed_out_at_a_limited_speed(void **state)
{
    struct vec3 push, twist;
    (void)state;
    struct rigid_body body = truck(-1.0, (struct vec3){0.0, 0.0, 0.0});
    ground_contacts_solve(&contacts, &body, DT_S);
    ground_contacts_push(&contacts, &body, DT_S, &push, &twist);
    assert_true(fabs(push.y - 3.0) < 1e-2 && vec3_length(body.velocity) < 1e-9);
    body = truck(-0.012, (struct vec3){0.0, 0.0, 0.0});
    ground_contacts_solve(&contacts, &body, DT_S);
    ground_contacts_push(&contacts, &body, DT_S, &push, &twist);
    assert_true(fabs(push.y - 0.3) < 1e-2); /* 0.3 of 10 mm in 10 ms */
    body = truck(-0.001, (struct vec3){0.0, 0.0, 0.0});
    ground_contacts_solve(&contacts, &body, DT_S);
    ground_contacts_push(&contacts, &body, DT_S, &push, &twist);
    assert_true(push.y == 0.0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_points_that_can_reach_the_ground_are_found),
        TEST(test_a_point_arrives_on_the_ground_and_not_under_it),
        TEST(test_restitution_falls_with_the_closing_speed),
        TEST(test_friction_is_within_its_cone),
        TEST(test_ploughing_slows_along_the_ground),
        TEST(test_soil_resists_rolling_and_turns_nothing_round),
        TEST(test_a_point_is_pushed_out_at_a_limited_speed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
