/* How a response changes a body's path in the rest of the frame. */
#include "collider/response/path_change.h"
#include "tests/support/steps.h"
#include "world/entity/free_rotation.h"
#include "world/entity/mass_properties.h"
#include "world/entity/wreck_drag.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define DT_S (1.0 / 60.0)

static struct fixture f;
static struct response_context context;
static const struct vec3 none = {0.0, 0.0, 0.0};

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

/* One body that goes 6 m east in the frame. */
static uint32_t put(const char *kind, double x, double y)
{
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                           .at = {x, y, 25000.0},
                                                           .velocity = {6.0 / DT_S, 0.0, 0.0}});
    steps_respond(&f, &context);
    context.path[row].along.x = 6.0;
    context.next->entities.row[row].x += 6.0;
    return row;
}

static double x_of(uint32_t row)
{
    return context.next->entities.row[row].x;
}

static void test_who_stays_ends_where_it_was_struck(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 25000.0, 900.0);
    path_change_stay(&context, row, 0.25, (struct vec3){3.0, 0.0, 0.0});
    assert_true(fabs(x_of(row) - 25001.5) < 1e-9);
    assert_true(context.next->entities.row[row].vx == 3.0);
    assert_true(context.path[row].since == 0.25 && pair_filter_rests(&context.path[row]));
}

static void test_who_is_slowed_goes_on_at_its_share(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 25000.0, 900.0);
    path_change_slow(&context, row, 0.5, 0.5);
    assert_true(fabs(x_of(row) - 25004.5) < 1e-9);
    assert_true(fabs(context.next->entities.row[row].vx - 3.0 / DT_S) < 1e-9);
}

static void test_who_leaves_takes_velocity_and_spin_along(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 25000.0, 900.0);
    struct vec3 at = {25002.0, 900.0, 25000.0}, velocity = {0.0, 0.0, 60.0};
    path_change_leave(&context, row, 0.5, at, velocity, (struct vec3){0.0, -6.0, 0.0}, false);
    const struct entities *e = &context.next->entities;
    assert_true(fabs(e->row[row].x - 25002.0) < 1e-9 && fabs(e->row[row].z - 25000.5) < 1e-9);
    /* Half of the frame at 6 rad/s to the right. */
    assert_true(fabs(maths_wrap_half(e->row[row].heading - HALF_PI) - 3.0 * DT_S) < 1e-9);
    assert_true(fabs(e->row[row].spin_y + 6.0) < 1e-9);
    path_change_leave(&context, row, 0.5, at, velocity, none, true);
    assert_true(e->row[row].z == 25000.0 &&
                e->row[row].vz == 60.0); /* stays, and takes it with it */
}

/* The weight does no work on a wreck that stays, and on another one no more than its fall. */
static void test_a_falling_wreck_gains_no_energy(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 25000.0, 900.0);
    struct entities *e = &context.next->entities;
    double fall = GRAVITY_MPS2 * DT_S;
    steps_rows(&f).row[row].state = e->row[row].state = ENTITY_WRECK;
    const struct mat3 axes = rotation_matrix(rotation_of(e->row[row].heading, 0.0, 0.0));
    entities_set_velocity(
        e, row,
        wreck_drag_slow(steps_kind(&f, "helicopter"), &axes, entities_velocity(e, row), DT_S));
    e->row[row].vy -= fall;
    struct vec3 at = {25001.5, 900.0, 25000.0},
                velocity = path_change_velocity(&context, row, 0.25);
    assert_true(fabs(velocity.y - (e->row[row].vy + 0.75 * fall)) < 1e-12);
    velocity.y = -5.0;
    path_change_leave(&context, row, 0.25, at, velocity, none, false);
    assert_true(fabs(e->row[row].vy - (-5.0 - 0.75 * fall)) < 1e-12);
    double before = 12.5, after = 0.5 * e->row[row].vy * e->row[row].vy;
    assert_true(fabs(after - before - GRAVITY_MPS2 * (900.0 - e->row[row].y)) < 1e-9);
    path_change_leave(&context, row, 0.5, at, velocity, none, true);
    assert_true(e->row[row].vy == -5.0 && e->row[row].y == 900.0);
}

/* Row 17 and the mover know nothing outside: no answer may push a body there. */
static void test_no_body_is_pushed_out_of_the_world(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 1.0, 900.0);
    const struct vec3 out = {-300.0, 0.0, 0.0};
    static const double times[] = {0.0, 0.5, 1.0};
    for (int i = 0; i < 3; i++) {
        struct vec3 at = {-0.5, 900.0, WORLD_SIDE_DEFAULT_M + 0.5}; /* parted from another */
        path_change_leave(&context, row, times[i], at, out, none, i == 2);
        assert_true(x_of(row) >= 0.0 && x_of(row) <= WORLD_SIDE_DEFAULT_M);
        assert_true(context.next->entities.row[row].z <= WORLD_SIDE_DEFAULT_M);
    }
}

static void test_what_the_ground_holds(void **state)
{
    (void)state;
    uint32_t tank = put("tank", 25000.0, FIXTURE_GROUND_M);
    steps_respond_end(&context);
    uint32_t jet = put("jet", 26000.0, 900.0);
    struct entities *e = &context.next->entities;
    assert_true(path_change_grounded(&context, tank));
    assert_false(path_change_grounded(&context, jet));
    /* A wreck in any pose whose lowest point is on the ground, and that is slow. */
    double half = 0.5 * steps_kind(&f, "jet")->width_m;
    e->row[jet].state = ENTITY_WRECK;
    e->row[jet].roll = HALF_PI;
    e->row[jet].vx = 0.0;
    assert_false(path_change_grounded(&context, jet)); /* it still falls */
    e->row[jet].y = FIXTURE_GROUND_M + half + 0.04;
    assert_true(path_change_grounded(&context, jet));
    e->row[jet].y = FIXTURE_GROUND_M + half + 0.06;
    assert_false(path_change_grounded(&context, jet));
    e->row[jet].y = FIXTURE_GROUND_M + half;
    e->row[jet].vx = 30.0;
    assert_true(path_change_grounded(&context, jet)); /* it slides */
    e->row[jet].vy = -3.0;
    assert_false(path_change_grounded(&context, jet)); /* it falls */
    e->row[jet].vx = e->row[jet].vy = 0.0;
    e->row[jet].spin_z = 1.5;
    assert_false(path_change_grounded(&context, jet)); /* it rolls over */
    e->row[jet].spin_z = 0.0;
    e->row[jet].spin_y = 0.5;
    e->row[jet].heading += 1.0; /* no driver has turned it so */
    assert_true(path_change_spin(&context, jet, 0.5).y == 0.5);
    /* Its driver's steering counts until an answer has turned it otherwise. */
    e->row[tank].spin_x = e->row[tank].spin_z = 1.0;
    e->row[tank].heading += 0.01;
    struct vec3 spin = path_change_spin(&context, tank, 0.5);
    assert_true(spin.x == 0.0 && spin.z == 0.0 && fabs(spin.y + 0.01 / DT_S) < 1e-9);
}

/* A wreck at rest that is displaced has to find its rest anew. */
static void test_a_displaced_wreck_is_awake(void **state)
{
    (void)state;
    uint32_t row = put("tank", 25000.0, FIXTURE_GROUND_M);
    struct entities *e = &context.next->entities;
    struct vec3 at = entities_position(e, row);
    context.path[row] = (struct path){.at = at};
    e->row[row].state = ENTITY_WRECK;
    e->row[row].until_tick = 7;
    path_change_leave(&context, row, 0.5, at, none, none, false);
    assert_int_equal(e->row[row].until_tick, 7);
    at.x += 0.01;
    path_change_leave(&context, row, 0.5, at, none, none, false);
    assert_int_equal(e->row[row].until_tick, 0);
}

/* Returns the velocity of a tank's centre of mass. */
static struct vec3 centre_velocity(uint32_t row)
{
    const struct entities *e = &context.next->entities;
    struct mat3 axes =
        rotation_matrix(rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll));
    struct vec3 up = {0.0, mass_properties_of(steps_kind(&f, "tank")).centre_m, 0.0};
    struct vec3 spin = {e->row[row].spin_x, e->row[row].spin_y, e->row[row].spin_z};
    return vec3_add(entities_velocity(e, row), vec3_cross(spin, rotation_apply(&axes, up)));
}

/* A wreck on the ground loses its rolling by a push. Its centre of mass gains no speed by that, and
 * it goes on as fast as it has become. */
static void test_a_pushed_wreck_gains_no_speed(void **state)
{
    (void)state;
    uint32_t row = put("tank", 25000.0, FIXTURE_GROUND_M);
    struct entities *e = &context.next->entities;
    e->row[row].state = ENTITY_WRECK;
    e->row[row].vx = 10.0;
    e->row[row].spin_x = 0.3;
    e->row[row].spin_y = 0.2;
    e->row[row].spin_z = -0.4;
    assert_true(path_change_grounded(&context, row));
    struct vec3 before = centre_velocity(row);
    struct vec3 at = entities_position(e, row);
    path_change_leave(&context, row, 0.5, at, path_change_velocity(&context, row, 0.5),
                      path_change_spin(&context, row, 0.5), false);
    struct vec3 way = vec3_scale(vec3_sub(entities_position(e, row), at), 2.0 / DT_S);
    assert_true(vec3_length(vec3_sub(way, entities_velocity(e, row))) < 1e-9);
    assert_true(e->row[row].spin_x == 0.0 && e->row[row].spin_y == 0.2 &&
                e->row[row].spin_z == 0.0);
    assert_true(vec3_length(vec3_sub(centre_velocity(row), before)) < 1e-12);
}

/* A driver who steers continues to steer after a response, and the steering does not become the
 * vehicle's spin. */
static void test_an_answer_leaves_the_steering_to_the_driver(void **state)
{
    (void)state;
    uint32_t tank = put("tank", 25000.0, FIXTURE_GROUND_M);
    struct entities *e = &context.next->entities;
    struct vec3 at = {25003.0, FIXTURE_GROUND_M, 25000.0};
    e->row[tank].heading += 0.01;
    struct vec3 spin = path_change_spin(&context, tank, 0.5);
    spin.y -= 0.3; /* what an impulse adds, to the right as he steers */
    path_change_leave(&context, tank, 0.5, at, none, spin, false);
    assert_true(fabs(e->row[tank].spin_y + 0.3) < 1e-9);
    assert_true(fabs(maths_wrap_half(e->row[tank].heading - HALF_PI) - 0.01 - 0.15 * DT_S) < 1e-9);
    assert_true(fabs(path_change_spin(&context, tank, 0.5).y - spin.y) < 1e-9);
}

/* The spin at a time in the frame is that of the orientation then: momentum and energy are those of
 * the frame's end. */
static void test_a_body_in_the_air_has_its_momentum_at_every_time(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", 25000.0, 900.0);
    struct vec3 at = {25003.0, 900.0, 25000.0}, spin = {20.0, -14.0, 11.0};
    const struct entities *e = &context.next->entities;
    struct vec3 moment = mass_properties_of(steps_kind(&f, "helicopter")).moment;
    struct quat turned = rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll);
    struct vec3 momentum = free_rotation_momentum(moment, turned, spin);
    double energy = vec3_dot(momentum, spin);
    path_change_leave(&context, row, 0.0, at, none, spin, false);
    for (double time = 0.0; time <= 1.0; time += 0.25) {
        spin = path_change_spin(&context, row, time);
        turned = body_motion_orientation(context.motion, row, time);
        struct vec3 now = free_rotation_momentum(moment, turned, spin);
        assert_true(vec3_length(vec3_sub(now, momentum)) < 1e-12 * vec3_length(momentum));
        assert_true(fabs(vec3_dot(now, spin) - energy) < 1e-12 * energy);
    }
    struct vec3 end = {e->row[row].spin_x, e->row[row].spin_y, e->row[row].spin_z};
    assert_true(vec3_length(vec3_sub(end, spin)) < 1e-12 * vec3_length(spin));
    spin = path_change_spin(&context, row, 0.5);
    path_change_stay(&context, row, 0.5, none);
    end = (struct vec3){e->row[row].spin_x, e->row[row].spin_y, e->row[row].spin_z};
    assert_true(vec3_length(vec3_sub(end, spin)) < 1e-12 * vec3_length(spin));
}

/* A turn that parts a body from what it overlaps is no spin: an impact would make energy of it. */
static void test_a_turn_that_parts_bodies_is_no_spin(void **state)
{
    (void)state;
    uint32_t tank = put("tank", 25000.0, 100.0);
    context.next->entities.row[tank].heading += 0.02;
    assert_true(fabs(path_change_spin(&context, tank, 0.5).y + 0.02 / DT_S) < 1e-9);
    context.motion->parting_rps[tank] = -0.02 / DT_S;
    assert_true(fabs(path_change_spin(&context, tank, 0.5).y) < 1e-9);
    context.motion->parting_rps[tank] = 0.0;
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_who_stays_ends_where_it_was_struck),
        TEST(test_who_is_slowed_goes_on_at_its_share),
        TEST(test_who_leaves_takes_velocity_and_spin_along),
        TEST(test_a_falling_wreck_gains_no_energy),
        TEST(test_no_body_is_pushed_out_of_the_world),
        TEST(test_what_the_ground_holds),
        TEST(test_a_turn_that_parts_bodies_is_no_spin),
        TEST(test_a_displaced_wreck_is_awake),
        TEST(test_a_pushed_wreck_gains_no_speed),
        TEST(test_an_answer_leaves_the_steering_to_the_driver),
        TEST(test_a_body_in_the_air_has_its_momentum_at_every_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
