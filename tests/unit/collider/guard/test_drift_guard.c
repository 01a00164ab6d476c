/* Aircraft that nobody steers go back along their path, and keep their momenta (row 46). */
#include "collider/guard/drift_guard.h"

#include "tests/support/steps.h"
#include "world/entity/free_rotation.h"
#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define ROWS 2u

static struct fixture f;
static struct response_context context;
static const struct vec3 begin_at = {25000.0, 400.0, 25000.0};

/* Two helicopters that fly east and turn, the second behind the first. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (uint32_t i = 0; i < ROWS; i++) {
        struct vec3 at = {begin_at.x - 30.0 * i, begin_at.y + 0.5 * i, begin_at.z + 2.0 * i};
        uint32_t row =
            fixture_put(&f, (struct fixture_entity){.kind = "helicopter",
                                                    .behaviour = BEHAVIOUR_HOLD,
                                                    .at = at,
                                                    .velocity = {30.0 + 10.0 * i, 1.0, -2.0}});
        struct entities e = steps_rows(&f);
        e.row[row].spin_x = 1.5, e.row[row].spin_y = -0.7 - i, e.row[row].spin_z = 0.3;
    }
    steps_respond(&f, &context);
    for (uint32_t i = 0; i < ROWS; i++) { /* as the mover moves them */
        struct entities *e = &context.next->entities;
        struct quat turn = rotation_of(e->row[i].heading, e->row[i].pitch, e->row[i].roll);
        struct vec3 spin = {e->row[i].spin_x, e->row[i].spin_y, e->row[i].spin_z};
        free_rotation_turn(mass_properties_of(steps_kind(&f, "helicopter")).moment, &turn, &spin,
                           1.0 / 60.0);
        rotation_angles(turn, &e->row[i].heading, &e->row[i].pitch, &e->row[i].roll);
        e->row[i].x += e->row[i].vx / 60.0, e->row[i].y += e->row[i].vy / 60.0,
            e->row[i].z += e->row[i].vz / 60.0;
        e->row[i].spin_x = spin.x, e->row[i].spin_y = spin.y, e->row[i].spin_z = spin.z;
        body_motion_compute(context.motion, i);
    }
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

struct sums {
    struct vec3 momentum, angular; /* the latter about where the first row began */
    struct vec3 about_centre;      /* and about the common centre of mass */
    double energy;
};

static struct sums sums_of(void)
{
    const struct entities *e = &context.next->entities;
    const struct mass_properties mass = mass_properties_of(steps_kind(&f, "helicopter"));
    struct sums sums = {.energy = 0.0};
    struct vec3 centre =
        vec3_scale(vec3_add(entities_position(e, 0), entities_position(e, 1)), 1.0 / ROWS);
    for (uint32_t i = 0; i < ROWS; i++) {
        struct quat turn = rotation_of(e->row[i].heading, e->row[i].pitch, e->row[i].roll);
        struct vec3 spin = {e->row[i].spin_x, e->row[i].spin_y, e->row[i].spin_z},
                    v = entities_velocity(e, i);
        struct vec3 own = free_rotation_momentum(mass.moment, turn, spin);
        struct vec3 momentum = vec3_scale(v, mass.mass_kg);
        struct vec3 off = vec3_sub(entities_position(e, i), begin_at);
        sums.momentum = vec3_add(sums.momentum, momentum);
        sums.angular = vec3_add(sums.angular, vec3_add(own, vec3_cross(off, momentum)));
        sums.energy += 0.5 * (vec3_dot(momentum, v) + vec3_dot(own, spin));
    }
    sums.about_centre =
        vec3_sub(sums.angular, vec3_cross(vec3_sub(centre, begin_at), sums.momentum));
    return sums;
}

static void same(struct vec3 now, struct vec3 before)
{
    assert_true(vec3_length(vec3_sub(now, before)) < 1e-9 * vec3_length(before));
}

static void test_only_aircraft_that_nobody_steers_drift(void **state)
{
    struct entities *e = &context.next->entities;
    (void)state;
    assert_true(drift_guard_drifts(&context, 0));
    e->row[0].behaviour = BEHAVIOUR_PATROL;
    assert_false(drift_guard_drifts(&context, 0));
    e->row[0].behaviour = BEHAVIOUR_HOLD;
    e->row[0].state = ENTITY_WRECK;
    assert_false(drift_guard_drifts(&context, 0));
    e->row[0].state = ENTITY_ACTIVE;
    e->row[0].kind = (uint16_t)(steps_kind(&f, "tank") - f.view.world.kinds);
    assert_false(drift_guard_drifts(&context, 0));
}

static void test_a_body_goes_back_along_its_path(void **state)
{
    const struct sums before = sums_of();
    const struct entities *e = &context.next->entities;
    struct vec3 velocity = entities_velocity(e, 0);
    (void)state;
    drift_guard_send_back(&context, 0, 0.25);
    assert_true(fabs(e->row[0].x - begin_at.x - 0.25 * 30.0 / 60.0) < 1e-9);
    assert_true(e->row[0].vx == velocity.x && e->row[0].vy == velocity.y &&
                e->row[0].vz == velocity.z);
    same(sums_of().angular, before.angular);
    drift_guard_send_back(&context, 0, 0.0); /* nothing has met: to the begin of its path */
    assert_true(fabs(e->row[0].x - begin_at.x) < 1e-9);
    same(sums_of().angular, before.angular);
}

/* Contacts have turned the body besides: a share of that turn is not on the way of a free one. */
static void test_a_share_of_another_turn_gains_no_energy(void **state)
{
    struct entities *e = &context.next->entities;
    double pitch = e->row[0].pitch;
    (void)state;
    for (int i = -4; i <= 4; i++) {
        e->row[0].pitch = pitch + 0.01 * i;
        const struct sums before = sums_of();
        double energy = before.energy;
        struct vec3 spin = {e->row[0].spin_x, e->row[0].spin_y, e->row[0].spin_z};
        double heading = e->row[0].heading, roll = e->row[0].roll;
        drift_guard_send_back(&context, 0, 0.25);
        same(sums_of().angular, before.angular);
        if (sums_of().energy > energy * (1.0 + 1e-9))
            fail_msg("turned by %g: energy %.17g of %.17g J", 0.01 * i, sums_of().energy, energy);
        e->row[0].heading = heading, e->row[0].roll = roll;
        e->row[0].spin_x = spin.x, e->row[0].spin_y = spin.y, e->row[0].spin_z = spin.z;
    }
}

/* After an impact in the middle of the frame a share is one of what is left of the path. */
static void test_a_share_is_one_of_the_path_since_the_last_impact(void **state)
{
    const struct entities *e = &context.next->entities;
    struct path path = context.path[0];
    struct rotation_path rotation = body_motion_rotation_from(context.motion, 0, 0.5);
    (void)state;
    path.at = path_at(&path, 0.5);
    path.since = 0.5;
    body_motion_change(context.motion, 0, &path, &rotation);
    drift_guard_send_back(&context, 0, 0.5);
    assert_true(fabs(e->row[0].x - begin_at.x - 0.75 * 30.0 / 60.0) < 1e-9);
    drift_guard_send_back(&context, 0, 0.0);
    assert_true(fabs(e->row[0].x - begin_at.x - 0.5 * 30.0 / 60.0) < 1e-9);
    drift_guard_send_back(&context, 0, -1.0);
    assert_true(e->row[0].x == begin_at.x && e->row[0].y == begin_at.y &&
                e->row[0].z == begin_at.z);
}

/* Tells that the rows have met, and sends the first back to where it began the frame. */
static void meet_and_send_back(void)
{
    uint32_t index = contact_queue_pair(context.contacts, &(struct pair){0, 1});
    context.contacts->met[index] = 1;
    drift_guard_send_back(&context, 0, -1.0);
}

static void test_what_goes_to_its_begin_gets_its_momenta_back(void **state)
{
    struct drift_guard drift;
    const struct sums before = sums_of();
    (void)state;
    assert_int_equal(drift_guard_init(&drift, &f.view.world), 0);
    context.path[0].at = path_at(&context.path[0], 0.5);
    context.path[0].at.z += 0.05; /* an impact has moved it out of the other */
    context.path[0].since = 0.5;
    context.next->entities.row[0].z += 0.05;
    struct sums shifted = sums_of();
    assert_true(vec3_length(vec3_sub(shifted.about_centre, before.about_centre)) > 10.0);
    meet_and_send_back();
    assert_true(vec3_length(vec3_sub(shifted.about_centre, sums_of().about_centre)) > 10.0);
    drift_guard_restore(&drift, &context, 0);
    same(sums_of().momentum, shifted.momentum);
    same(sums_of().about_centre, shifted.about_centre);
    assert_true(sums_of().energy <= shifted.energy * (1.0 + 1e-12));
    drift_guard_forget(&drift);
    drift_guard_free(&drift);
}

static void test_momenta_are_not_shared_with_what_does_not_drift(void **state)
{
    struct drift_guard drift;
    const struct entities *e = &context.next->entities;
    (void)state;
    assert_int_equal(drift_guard_init(&drift, &f.view.world), 0);
    e->row[1].behaviour = BEHAVIOUR_PATROL;
    meet_and_send_back();
    struct vec3 velocity = entities_velocity(e, 0);
    drift_guard_restore(&drift, &context, 0);
    assert_true(e->row[0].vx == velocity.x && e->row[0].vy == velocity.y &&
                e->row[0].vz == velocity.z);
    drift_guard_forget(&drift);
    drift_guard_free(&drift);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_only_aircraft_that_nobody_steers_drift),
        TEST(test_a_body_goes_back_along_its_path),
        TEST(test_a_share_of_another_turn_gains_no_energy),
        TEST(test_a_share_is_one_of_the_path_since_the_last_impact),
        TEST(test_what_goes_to_its_begin_gets_its_momenta_back),
        TEST(test_momenta_are_not_shared_with_what_does_not_drift),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
