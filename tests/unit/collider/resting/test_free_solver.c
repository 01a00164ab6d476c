/* Sequential impulses in all directions: a body on a fixed one, friction, momentum, split impulses.
 */
#include "collider/resting/free_solver.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define MASS_KG   1000.0
#define INVERSE   (1.0 / MASS_KG)
#define FALL_MPS  0.16
#define CLOSE_MPS 1e-4

static struct free_body body_of(double vx, double vy)
{
    return (struct free_body){
        .inverse_mass = INVERSE,
        .inverse_inertia = {{{1e-3, 0, 0}, {0, 1e-3, 0}, {0, 0, 1e-3}}},
        .moved = {.velocity = {vx, vy, 0.0}},
    };
}

/* Four points under a box of 2 m by 2 m whose middle is 0.5 m up. */
static void stand_on(struct free_contact contact[4], uint32_t a, uint32_t b, double friction)
{
    for (uint32_t i = 0; i < 4; i++)
        contact[i] = (struct free_contact){
            .a = a,
            .b = b,
            .normal = {0.0, 1.0, 0.0},
            .arm_a = {i & 1 ? 1.0 : -1.0, 0.5, i & 2 ? 1.0 : -1.0},
            .arm_b = {i & 1 ? 1.0 : -1.0, -0.5, i & 2 ? 1.0 : -1.0},
            .friction = friction,
        };
}

static void test_a_body_on_the_ground_stops(void **state)
{
    struct free_body body[2] = {{.inverse_mass = 0.0}, body_of(0.0, -FALL_MPS)};
    struct free_contact contact[4];
    double sum = 0.0;
    (void)state;
    stand_on(contact, 0, 1, 0.5);
    free_solver_run(body, 2, contact, 4);
    for (uint32_t i = 0; i < 4; i++) {
        sum += contact[i].impulse_ns[FREE_NORMAL];
        assert_true(free_solver_closing(body, &contact[i]) < CLOSE_MPS);
    }
    assert_true(fabs(sum - MASS_KG * FALL_MPS) < 0.5);
    assert_true(vec3_length(body[1].moved.velocity) < CLOSE_MPS);
}

/* The impulse of friction is at most its coefficient times that along the normal. */
static void test_friction_stays_within_its_cone(void **state)
{
    struct free_body body[2] = {{.inverse_mass = 0.0}, body_of(1.0, -FALL_MPS)};
    struct free_contact contact[4];
    (void)state;
    stand_on(contact, 0, 1, 0.5);
    free_solver_run(body, 2, contact, 4);
    for (uint32_t i = 0; i < 4; i++) {
        double along = contact[i].impulse_ns[FREE_ALONG],
               across = contact[i].impulse_ns[FREE_ACROSS];
        assert_true(sqrt(along * along + across * across) <=
                    0.5 * contact[i].impulse_ns[FREE_NORMAL] + 1e-9);
    }
    assert_true(body[1].moved.velocity.x < 1.0 && body[1].moved.velocity.x > 0.8);
}

/* Two free bodies that close on each other keep their momentum, and do not bounce. */
static void test_momentum_is_conserved(void **state)
{
    struct free_body body[3] = {{.inverse_mass = 0.0}, body_of(0.3, 0.5), body_of(-0.2, -0.7)};
    struct free_contact contact[4];
    (void)state;
    stand_on(contact, 1, 2, 0.5);
    free_solver_run(body, 3, contact, 4);
    struct vec3 sum = vec3_add(body[1].moved.velocity, body[2].moved.velocity);
    assert_true(vec3_length(vec3_sub(sum, (struct vec3){0.1, -0.2, 0.0})) < 1e-12);
    assert_true(fabs(body[2].moved.velocity.y - body[1].moved.velocity.y) < CLOSE_MPS);
}

/* The ground holds a vehicle under a body up, and its grip keeps it where it is. */
static void test_a_held_body_bears_the_load(void **state)
{
    struct free_body body[3] = {{.inverse_mass = 0.0}, body_of(0.0, 0.0), body_of(0.3, -FALL_MPS)};
    struct free_contact contact[4];
    (void)state;
    body[1].held = true;
    body[1].up = (struct vec3){0.0, 1.0, 0.0};
    body[1].forward = (struct vec3){1.0, 0.0, 0.0};
    body[1].most = (struct free_grip){1e4, 1e4, 1e4};
    body[1].inverse_inertia = (struct mat3){{{0, 0, 0}, {0, 1e-3, 0}, {0, 0, 0}}};
    stand_on(contact, 1, 2, 0.9);
    free_solver_run(body, 3, contact, 4);
    assert_true(vec3_length(body[1].moved.velocity) == 0.0);
    assert_true(body[1].moved.spin.y == 0.0);
    assert_true(fabs(body[2].moved.velocity.y) < CLOSE_MPS);
}

/* It goes down a slope of 45 degrees onto what stands fast. If it could be slowed down horizontally
 * only, it would be thrown aside, because nothing takes the vertical part of its motion. */
static void test_a_held_body_is_slowed_along_the_ground(void **state)
{
    struct free_body body[2] = {{.inverse_mass = 0.0}, body_of(2.0, -2.0)};
    struct free_contact contact = {.a = 0,
                                   .b = 1,
                                   .normal = {0.28, 0.96, 0.0},
                                   .arm_a = {0.0, 0.0, 0.0},
                                   .arm_b = {0.0, 0.0, 0.0}};
    (void)state;
    body[1].held = true;
    body[1].up = (struct vec3){sqrt(0.5), sqrt(0.5), 0.0};
    body[1].inverse_inertia = (struct mat3){{{0, 0, 0}, {0, 1e-3, 0}, {0, 0, 0}}};
    free_solver_run(body, 2, &contact, 1);
    assert_true(free_solver_closing(body, &contact) < CLOSE_MPS);
    assert_true(fabs(vec3_dot(body[1].moved.velocity, body[1].up)) < CLOSE_MPS);
    assert_true(vec3_length(body[1].moved.velocity) < CLOSE_MPS);
}

/* A gap may be closed within the frame, and no faster. */
static void test_a_gap_leaves_room(void **state)
{
    struct free_body body[2] = {{.inverse_mass = 0.0}, body_of(0.0, -1.0)};
    struct free_contact contact[4];
    (void)state;
    stand_on(contact, 0, 1, 0.5);
    for (uint32_t i = 0; i < 4; i++)
        contact[i].least_mps = -0.6;
    free_solver_run(body, 2, contact, 4);
    assert_true(fabs(body[1].moved.velocity.y + 0.6) < CLOSE_MPS);
}

/* An overlap is recovered by a motion that is no velocity. */
static void test_an_overlap_is_pushed_apart_without_energy(void **state)
{
    struct free_body body[2] = {{.inverse_mass = 0.0}, body_of(0.0, 0.0)};
    struct free_contact contact[4];
    (void)state;
    stand_on(contact, 0, 1, 0.5);
    for (uint32_t i = 0; i < 4; i++)
        contact[i].apart_mps = 0.2;
    free_solver_run(body, 2, contact, 4);
    assert_true(vec3_length(body[1].moved.velocity) == 0.0);
    assert_true(fabs(body[1].pushed.velocity.y - 0.2) < 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_body_on_the_ground_stops),
        cmocka_unit_test(test_friction_stays_within_its_cone),
        cmocka_unit_test(test_momentum_is_conserved),
        cmocka_unit_test(test_a_held_body_bears_the_load),
        cmocka_unit_test(test_a_held_body_is_slowed_along_the_ground),
        cmocka_unit_test(test_a_gap_leaves_room),
        cmocka_unit_test(test_an_overlap_is_pushed_apart_without_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
