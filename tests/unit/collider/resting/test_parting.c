/* Bodies that are deep in each other part without velocity, and within the bounds of others. */
#include "collider/resting/parting.h"

#include "collider/resting/resting.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define BODIES  3u
#define DEPTH_M 0.1

static struct fixture f;
static struct response_context context;
static struct parting parting;
static struct level_lanes lanes;
static struct crowds crowds;
static struct level_body body[BODIES];
static struct level_contact point[2];
static struct resting_pair pair[2];
static const uint32_t row[BODIES] = {0, 1, 2};
static struct parting_input input;

/* Trucks from west to east: the first two are deep in each other. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (uint32_t i = 0; i < BODIES; i++) {
        fixture_put(&f, (struct fixture_entity){
                            .kind = "truck", .at = {25000.0 + 6.0 * i, FIXTURE_GROUND_M, 25000.0}});
        body[i] =
            (struct level_body){.inverse_mass = 1e-4, .inverse_moment = 1e-5, .forward_x = 1.0};
    }
    steps_respond(&f, &context);
    assert_int_equal(parting_init(&parting, BODIES, 2), 0);
    assert_int_equal(level_lanes_init(&lanes, BODIES, 2), 0);
    assert_int_equal(crowds_init(&crowds, &f.view.world), 0);
    double dt_s = world_dt_s(&f.view.world);
    point[0] = (struct level_contact){
        .a = 0, .b = 1, .normal_x = 1.0, .apart_mps = PARTING_SHARE * DEPTH_M / dt_s};
    point[1] = (struct level_contact){.a = 1, .b = 2, .normal_x = 1.0};
    pair[0] = (struct resting_pair){.first = 0, .count = 1, .gap_m = -DEPTH_M};
    pair[1] = (struct resting_pair){.first = 1, .count = 1, .gap_m = CONTACT_REST_M};
    input = (struct parting_input){.context = &context,
                                   .crowds = &crowds,
                                   .lanes = &lanes,
                                   .row = row,
                                   .body = body,
                                   .point = point,
                                   .pair = pair,
                                   .bodies = 2,
                                   .points = 1,
                                   .pairs = 1};
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    parting_free(&parting);
    level_lanes_free(&lanes);
    crowds_free(&crowds);
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

static double apart_mps(uint32_t a, uint32_t b)
{
    return body[b].pushed.x - body[a].pushed.x;
}

static void test_the_whole_depth_parts_in_a_frame(void **state)
{
    (void)state;
    parting_run(&parting, &input);
    assert_true(fabs(apart_mps(0, 1) * world_dt_s(&f.view.world) - DEPTH_M) < 1e-6);
    assert_true(fabs(body[0].pushed.x + body[1].pushed.x) < 1e-9); /* equal masses share it */
    assert_true(body[0].moved.x == 0.0 && body[0].pushed.spin == 0.0);
}

static void test_a_wall_does_not_give_way(void **state)
{
    const uint32_t with_wall[BODIES] = {0, SLOT_NONE, 2};
    (void)state;
    body[1].inverse_mass = body[1].inverse_moment = 0.0;
    input.row = with_wall;
    parting_run(&parting, &input);
    assert_true(body[1].pushed.x == 0.0);
    assert_true(fabs(apart_mps(0, 1) * world_dt_s(&f.view.world) - DEPTH_M) < 1e-6);
}

/* The third touches the second: it is pushed on, and no deeper in it than before. */
static void test_a_neighbour_is_pushed_on(void **state)
{
    (void)state;
    input.bodies = 3, input.points = input.pairs = 2;
    parting_run(&parting, &input);
    assert_true(apart_mps(1, 2) > -1e-6);
    assert_true(body[2].pushed.x > 0.0);
    assert_true(apart_mps(0, 1) > 0.0);
}

/* A wall behind the second: it has no way to go, and the first goes all of it. */
static void test_nobody_is_pushed_into_a_wall(void **state)
{
    const uint32_t with_wall[BODIES] = {0, 1, SLOT_NONE};
    (void)state;
    body[2].inverse_mass = body[2].inverse_moment = 0.0;
    input.row = with_wall;
    input.bodies = 3, input.points = input.pairs = 2;
    parting_run(&parting, &input);
    assert_true(body[1].pushed.x < 1e-6);
    assert_true(body[2].pushed.x == 0.0);
    assert_true(apart_mps(0, 1) > 0.0);
}

static void test_shallow_overlaps_are_the_solvers(void **state)
{
    (void)state;
    pair[0].gap_m = -0.5 * RESTING_PARTS_M;
    point[0].apart_mps = 0.3;
    level_solver_run(&lanes, body, input.bodies, point, input.points);
    parting_run(&parting, &input);
    assert_true(fabs(apart_mps(0, 1) - 0.3) < 1e-6); /* its share, not the whole depth */
}

/* A body of a row that presses on it may have many overlaps behind it. */
static void test_recovery_moves_nobody_far_in_a_frame(void **state)
{
    (void)state;
    pair[0].gap_m = -0.9 * RESTING_PARTS_M;
    point[0].apart_mps = 2.0;
    level_solver_run(&lanes, body, 2, point, 1);
    parting_run(&parting, &input);
    assert_true(fabs(body[0].pushed.x * world_dt_s(&f.view.world) + 0.006) < 1e-9);
    assert_true(fabs(body[1].pushed.x * world_dt_s(&f.view.world) - 0.006) < 1e-9);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_the_whole_depth_parts_in_a_frame),
        TEST(test_a_wall_does_not_give_way),
        TEST(test_a_neighbour_is_pushed_on),
        TEST(test_nobody_is_pushed_into_a_wall),
        TEST(test_shallow_overlaps_are_the_solvers),
        TEST(test_recovery_moves_nobody_far_in_a_frame),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
