/* Contacts of bodies in the plane: what they conserve, what they stop, and what the ground holds.
 */
#include "collider/solver/level_solver.h"

#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define BODIES   5
#define CONTACTS 8
#define ROUNDS   2000

static struct level_lanes lanes;
static struct level_body body[BODIES];
static struct level_contact contact[CONTACTS];
static double at_x[BODIES], at_z[BODIES];

/* A body of this mass that the ground does not hold, heading east. */
static struct level_body put(double mass_kg, double x, double z)
{
    return (struct level_body){.inverse_mass = 1.0 / mass_kg,
                               .inverse_moment = 1.0 / (2.0 * mass_kg),
                               .moved = {x, z, 0.0},
                               .forward_x = 1.0};
}

/* A contact of bodies whose centres are 2 m apart, the second to the east of the first. */
static struct level_contact touch(uint32_t a, uint32_t b)
{
    return (struct level_contact){.a = a, .b = b, .normal_x = 1.0, .a_x = 1.0, .b_x = -1.0};
}

/* --- random bodies -----------------------------------------------------------------------------*/

struct sums {
    double x, z, angular, energy;
};

static struct sums sums_of(const struct level_body *of)
{
    struct sums sums = {0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < BODIES; i++) {
        const struct level_motion *v = &of[i].moved;
        double kg = 1.0 / of[i].inverse_mass, moment = 1.0 / of[i].inverse_moment;
        sums.x += kg * v->x;
        sums.z += kg * v->z;
        sums.angular += kg * (at_z[i] * v->x - at_x[i] * v->z) + moment * v->spin;
        sums.energy += 0.5 * (kg * (v->x * v->x + v->z * v->z) + moment * v->spin * v->spin);
    }
    return sums;
}

static void draw(uint64_t *random)
{
    for (int i = 0; i < BODIES; i++) {
        body[i] = put(fixture_uniform(random, 500.0, 40000.0), fixture_uniform(random, -9.0, 9.0),
                      fixture_uniform(random, -9.0, 9.0));
        body[i].moved.spin = fixture_uniform(random, -2.0, 2.0);
        at_x[i] = fixture_uniform(random, -5.0, 5.0);
        at_z[i] = fixture_uniform(random, -5.0, 5.0);
    }
    for (int i = 0; i < CONTACTS; i++) {
        uint32_t a = (uint32_t)(fixture_random(random) % BODIES);
        uint32_t b = (a + 1 + (uint32_t)(fixture_random(random) % (BODIES - 1))) % BODIES;
        double angle = fixture_uniform(random, 0.0, TWO_PI), x = fixture_uniform(random, -5.0, 5.0);
        double z = fixture_uniform(random, -5.0, 5.0), gap = fixture_uniform(random, -1.0, 1.0);
        contact[i] = (struct level_contact){.a = a,
                                            .b = b,
                                            .a_x = x - at_x[a],
                                            .a_z = z - at_z[a],
                                            .b_x = x - at_x[b],
                                            .b_z = z - at_z[b],
                                            .least_mps = gap > 0.0 ? -gap : 0.0,
                                            .apart_mps = gap < 0.0 ? -gap : 0.0,
                                            .friction = fixture_uniform(random, 0.0, 1.0)};
        maths_sincos(angle, &contact[i].normal_x, &contact[i].normal_z);
    }
}

static void test_momentum_is_conserved_and_energy_never_grows(void **state)
{
    uint64_t random = fixture_seed(131);
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        draw(&random);
        struct sums before = sums_of(body);
        level_solver_run(&lanes, body, BODIES, contact, CONTACTS);
        struct sums after = sums_of(body);
        double scale = 1e-12 * 4e4 * 9.0 * 10.0 * BODIES; /* of the greatest momentum */
        assert_true(fabs(after.x - before.x) < scale && fabs(after.z - before.z) < scale);
        assert_true(fabs(after.angular - before.angular) < scale);
        assert_true(after.energy <= before.energy * (1.0 + 1e-12));
        for (int i = 0; i < CONTACTS; i++)
            assert_true(contact[i].normal_ns >= 0.0);
    }
}

/* Whatever impulses the points begin with. */
static void test_a_warm_start_adds_no_energy(void **state)
{
    uint64_t random = fixture_seed(132);
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        draw(&random);
        for (int i = 0; i < CONTACTS; i++) {
            contact[i].normal_ns = fixture_uniform(&random, 0.0, 2e5);
            contact[i].friction_ns = fixture_uniform(&random, -2e5, 2e5);
        }
        struct sums before = sums_of(body);
        level_solver_run(&lanes, body, BODIES, contact, CONTACTS);
        struct sums after = sums_of(body);
        double scale = 1e-12 * 4e5 * 9.0 * 10.0 * BODIES;
        assert_true(fabs(after.x - before.x) < scale && fabs(after.z - before.z) < scale);
        assert_true(fabs(after.angular - before.angular) < scale);
        assert_true(after.energy <= before.energy * (1.0 + 1e-12));
        for (int i = 0; i < CONTACTS; i++)
            assert_true(contact[i].normal_ns >= 0.0);
    }
}

/* A long row of bodies against a wall, each of which pushes: from 0 the sweeps do not suffice. */
#define ROW 40

/* Returns the greatest speed at which two still close after so many frames. */
static double left_in_row(int frames, bool warm)
{
    static struct level_body row[ROW + 1];
    static struct level_contact between[ROW];
    double most = 0.0;
    for (uint32_t i = 0; i < ROW; i++)
        between[i] = touch(i, i + 1);
    for (int frame = 0; frame < frames; frame++) {
        for (uint32_t i = 0; i < ROW; i++)
            row[i] = put(1000.0, 0.1, 0.0);
        row[ROW] = (struct level_body){.forward_x = 1.0};
        for (uint32_t i = 0; i < ROW; i++)
            between[i].normal_ns = warm ? between[i].normal_ns : 0.0;
        level_solver_run(&lanes, row, ROW + 1, between, ROW);
    }
    for (uint32_t i = 0; i < ROW; i++)
        most = maths_max(most, level_solver_closing(row, &between[i]));
    return most;
}

static void test_a_warm_start_goes_on_where_the_last_frame_ended(void **state)
{
    (void)state;
    double cold = left_in_row(60, false);
    assert_true(cold > 0.01 && left_in_row(60, true) < 0.3 * cold);
}

static void test_friction_stays_within_its_cone(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        body[0] = put(1000.0, 2.0, i == 0 ? 0.1 : 9.0); /* slips a little, and much */
        body[1] = put(1000.0, 0.0, 0.0);
        body[0].inverse_moment = body[1].inverse_moment = 1e-12;
        contact[0] = touch(0, 1);
        contact[0].friction = 0.5;
        level_solver_run(&lanes, body, 2, contact, 1);
        double left = fabs(body[0].moved.z - body[1].moved.z);
        assert_true(fabs(contact[0].normal_ns - 1000.0) < 1e-6);     /* 500 kg times 2 m/s */
        assert_true(i == 0 ? left < 1e-9 : fabs(left - 8.0) < 1e-9); /* 500 N s on 500 kg */
    }
}

/* --- what contacts stop ------------------------------------------------------------------------*/

/* Returns the greatest speed at which two of the chain close after its first or last body, which
 * moves towards the others, has pushed them. */
static double left_in_chain(bool from_first)
{
    double most = 0.0;
    for (uint32_t i = 0; i < BODIES; i++)
        body[i] = put(10000.0, 0.0, 0.0);
    if (from_first)
        body[0].moved.x = 1.0;
    else
        body[BODIES - 1].moved.x = -1.0;
    for (uint32_t i = 0; i + 1 < BODIES; i++)
        contact[i] = touch(i, i + 1);
    level_solver_run(&lanes, body, BODIES, contact, BODIES - 1);
    for (uint32_t i = 0; i + 1 < BODIES; i++)
        most = maths_max(most, level_solver_closing(body, &contact[i]));
    return most;
}

static void test_a_chain_of_pushed_bodies_does_not_close(void **state)
{
    (void)state;
    double east = left_in_chain(true);
    assert_true(body[BODIES - 1].moved.x > 0.19); /* all together: 0.2 m/s */
    double west = left_in_chain(false);
    assert_true(body[0].moved.x < -0.19);
    assert_true(east < 1e-4 && west < 1e-4);
}

static void test_bodies_may_close_a_gap_but_not_more(void **state)
{
    (void)state;
    body[0] = put(1000.0, 3.0, 0.0);
    body[1] = put(1000.0, 0.0, 0.0);
    contact[0] = touch(0, 1);
    contact[0].least_mps = -0.5;
    level_solver_run(&lanes, body, 2, contact, 1);
    assert_true(fabs(level_solver_closing(body, &contact[0]) - 0.5) < 1e-12);
    body[0].moved.x = 0.4, body[1].moved.x = 0.0;
    level_solver_run(&lanes, body, 2, contact, 1);
    assert_true(body[0].moved.x == 0.4 && body[1].moved.x == 0.0 && contact[0].normal_ns == 0.0);
}

static void test_a_fixed_body_bears_all(void **state)
{
    (void)state;
    body[0] = put(1000.0, 3.0, 0.0);
    body[1] = (struct level_body){.forward_x = 1.0};
    contact[0] = contact[1] = touch(0, 1);
    contact[1].a = 1, contact[1].b = 2; /* two fixed bodies */
    body[2] = body[1];
    level_solver_run(&lanes, body, 3, contact, 2);
    assert_true(fabs(body[0].moved.x) < 1e-12 && body[1].moved.x == 0.0);
    assert_true(fabs(contact[0].normal_ns - 3000.0) < 1e-9 && contact[1].normal_ns == 0.0);
}

/* --- the ground --------------------------------------------------------------------------------*/

/* Returns the braked body's speed after the push of another body with this speed and the same mass.
 */
static double pushed_at(double speed_mps)
{
    body[0] = put(1000.0, speed_mps, 0.0);
    body[1] = put(1000.0, 0.0, 0.0);
    body[1].grip_along = 200.0;
    contact[0] = touch(0, 1);
    level_solver_run(&lanes, body, 2, contact, 1);
    return body[1].moved.x;
}

static void test_grip_holds_against_a_weaker_push_only(void **state)
{
    (void)state;
    assert_true(fabs(pushed_at(0.19)) < 1e-6);      /* 190 N s */
    assert_true(fabs(pushed_at(1.0) - 0.4) < 1e-6); /* 1000 N s less the 200 of the ground */
}

static void test_grip_is_by_direction_and_holds_the_heading(void **state)
{
    (void)state;
    body[0] = put(1000.0, 0.1, 0.0);
    body[1] = put(1000.0, 0.0, 0.0);
    body[1].forward_x = 0.0, body[1].forward_z = 1.0; /* pushed at its side */
    body[1].grip_across = 200.0;
    contact[0] = touch(0, 1);
    contact[0].b_z = 1.0; /* off its centre */
    level_solver_run(&lanes, body, 2, contact, 1);
    assert_true(fabs(body[1].moved.x) < 1e-6 && fabs(body[1].moved.spin) > 0.01);
    body[0].moved = (struct level_motion){0.1, 0.0, 0.0};
    body[1].moved = (struct level_motion){0.0, 0.0, 0.0};
    contact[0].normal_ns = contact[0].friction_ns = 0.0;
    body[1].grip_turn = 400.0;
    level_solver_run(&lanes, body, 2, contact, 1);
    assert_true(fabs(body[1].moved.x) < 1e-6 && fabs(body[1].moved.spin) < 1e-6);
}

/* --- overlaps ----------------------------------------------------------------------------------*/

static void test_recovery_leaves_velocities_alone(void **state)
{
    (void)state;
    body[0] = put(1000.0, 0.0, 0.0);
    body[1] = put(3000.0, 0.0, 0.0);
    contact[0] = touch(0, 1);
    contact[0].apart_mps = 2.0;
    level_solver_run(&lanes, body, 2, contact, 1);
    level_solver_part(&lanes, body, 2, contact, 1);
    assert_true(body[0].moved.x == 0.0 && body[1].moved.x == 0.0);
    assert_true(fabs(body[0].pushed.x + 1.5) < 1e-12); /* the lighter body goes further */
    assert_true(fabs(body[1].pushed.x - 0.5) < 1e-12);
}

/* The third body stands beside the second, and is moved on without closing on it. */
static void test_recovery_pushes_no_body_into_the_next(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 3; i++)
        body[i] = put(1000.0, 0.0, 0.0);
    contact[0] = touch(0, 1);
    contact[0].apart_mps = 1.0;
    contact[1] = touch(1, 2);
    level_solver_run(&lanes, body, 3, contact, 2);
    level_solver_part(&lanes, body, 3, contact, 2);
    assert_true(body[1].pushed.x - body[0].pushed.x > 0.999);
    assert_true(body[2].pushed.x - body[1].pushed.x > -1e-3 && body[2].pushed.x > 0.3);
}

static int open_lanes(void **state)
{
    (void)state;
    return level_lanes_init(&lanes, BODIES, CONTACTS); /* the row makes them grow */
}

static int close_lanes(void **state)
{
    (void)state;
    level_lanes_free(&lanes);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_momentum_is_conserved_and_energy_never_grows),
        cmocka_unit_test(test_a_warm_start_adds_no_energy),
        cmocka_unit_test(test_a_warm_start_goes_on_where_the_last_frame_ended),
        cmocka_unit_test(test_friction_stays_within_its_cone),
        cmocka_unit_test(test_a_chain_of_pushed_bodies_does_not_close),
        cmocka_unit_test(test_bodies_may_close_a_gap_but_not_more),
        cmocka_unit_test(test_a_fixed_body_bears_all),
        cmocka_unit_test(test_grip_holds_against_a_weaker_push_only),
        cmocka_unit_test(test_grip_is_by_direction_and_holds_the_heading),
        cmocka_unit_test(test_recovery_leaves_velocities_alone),
        cmocka_unit_test(test_recovery_pushes_no_body_into_the_next),
    };
    return cmocka_run_group_tests(tests, open_lanes, close_lanes);
}
