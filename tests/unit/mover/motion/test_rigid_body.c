/* Free motion of a rigid body: rows become bodies and back, and rotation keeps what it must. */
#include "mover/motion/rigid_body.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct rigid_body tumbling(void)
{
    const struct kind kind = {.domain = DOMAIN_LAND,
                              .mass_kg = 50000.0,
                              .length_m = 7.9,
                              .width_m = 3.7,
                              .height_m = 2.5};
    return (struct rigid_body){.inertia = mass_properties_of(&kind),
                               .turn = rotation_of(1.0, 0.4, -2.0),
                               .centre = {25000.0, 120.0, 25000.0},
                               .velocity = {3.0, -2.0, 7.0},
                               .spin = {0.3, 3.0, 0.4}};
}

static void test_a_row_becomes_a_body_and_back(void **state)
{
    struct fixture f;
    struct step_context context;
    struct serial_context serial;
    (void)state;
    fixture_open(&f, "");
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                           .at = {25000.0, 130.0, 25000.0},
                                                           .velocity = {5.0, 1.0, -2.0}});
    struct entities e = steps_rows(&f);
    e.row[row].heading = 2.0;
    e.row[row].pitch = 0.3;
    e.row[row].roll = 2.5;
    e.row[row].spin_x = 1.0;
    e.row[row].spin_z = -2.0;
    steps_serial_context(&f, &context, &serial);
    const struct rigid_body body = rigid_body_take(&context, row);
    /* The centre is 1 m along the body's up axis; spin moves it. */
    struct vec3 arm = vec3_sub(body.centre, (struct vec3){25000.0, 130.0, 25000.0});
    assert_true(fabs(vec3_length(arm) - 1.0) < 1e-9 && arm.y < 0.0);
    struct vec3 by_spin = vec3_sub(body.velocity, (struct vec3){5.0, 1.0, -2.0});
    assert_true(fabs(vec3_dot(by_spin, arm)) < 1e-9 && vec3_length(by_spin) > 0.5);
    rigid_body_put(&context, row, &body);
    const struct entities *m = context.m;
    assert_true(fabs(m->row[row].x - 25000.0) < 1e-9 && fabs(m->row[row].y - 130.0) < 1e-9);
    assert_true(fabs(m->row[row].vx - 5.0) < 1e-9 && fabs(m->row[row].vy - 1.0) < 1e-9);
    assert_true(fabs(m->row[row].heading - 2.0) < 1e-9 && fabs(m->row[row].pitch - 0.3) < 1e-9);
    assert_true(fabs(m->row[row].roll - 2.5) < 1e-9 && m->row[row].spin_z == -2.0);
    fixture_close(&f);
}

static void test_the_edge_of_the_world_stops_a_body(void **state)
{
    struct fixture f;
    struct step_context context;
    struct serial_context serial;
    (void)state;
    fixture_open(&f, "");
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = "jet",
                                                           .at = {1.0, 130.0, 25000.0},
                                                           .velocity = {-90.0, 0.0, 4.0}});
    steps_serial_context(&f, &context, &serial);
    struct rigid_body body = rigid_body_take(&context, row);
    body.centre.x = -3.0;
    rigid_body_put(&context, row, &body);
    assert_true(context.m->row[row].x == 0.0 && context.m->row[row].vx == 0.0 &&
                context.m->row[row].vz == 4.0);
    fixture_close(&f);
}

static struct vec3 momentum_of(const struct rigid_body *body)
{
    struct mat3 turn = rotation_matrix(body->turn);
    struct vec3 w = rotation_back(&turn, body->spin), moment = body->inertia.moment;
    return rotation_apply(&turn, (struct vec3){moment.x * w.x, moment.y * w.y, moment.z * w.z});
}

static void test_a_free_rotation_gains_no_energy(void **state)
{
    struct rigid_body body = tumbling();
    struct vec3 momentum = momentum_of(&body);
    double energy = rigid_body_energy(&body), first = energy;
    (void)state;
    for (int n = 0; n < 120 * 60; n++) {
        rigid_body_turn(&body, (struct vec3){0.0, 0.0, 0.0}, 1.0 / 120.0);
        double now = rigid_body_energy(&body);
        assert_true(now <= energy * (1.0 + 1e-14));
        energy = now;
    }
    assert_true(energy > 0.99 * first);
    struct vec3 off = vec3_sub(momentum_of(&body), momentum);
    assert_true(vec3_length(off) < 0.05 * vec3_length(momentum));
}

static void test_energy_is_limited_by_slowing(void **state)
{
    struct rigid_body body = tumbling();
    double energy = rigid_body_energy(&body);
    (void)state;
    rigid_body_limit_energy(&body, energy);
    assert_true(body.velocity.x == 3.0);
    rigid_body_limit_energy(&body, energy - 1e5);
    assert_true(fabs(rigid_body_energy(&body) - (energy - 1e5)) < 1e-3);
    assert_true(body.velocity.x < 3.0 && body.spin.y < 3.0);
    rigid_body_limit_energy(&body, 0.0); /* less than its potential energy */
    assert_true(vec3_length(body.velocity) == 0.0 && vec3_length(body.spin) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_row_becomes_a_body_and_back),
        cmocka_unit_test(test_the_edge_of_the_world_stops_a_body),
        cmocka_unit_test(test_a_free_rotation_gains_no_energy),
        cmocka_unit_test(test_energy_is_limited_by_slowing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
