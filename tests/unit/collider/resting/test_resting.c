/* Contacts that last are solved before impacts: what presses, what parts, and what stays. */
#include "collider/resting/resting.h"

#include "collider/geometry/level_gap.h"
#include "collider/response/path_change.h"
#include "tests/support/steps.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define ROWS   3u
#define WEST_M 25000.0

static struct fixture f;
static struct response_context context;
static struct resting *resting;
static double nose_to_tail; /* [m] between the positions of trucks that touch */

static void begin(void)
{
    steps_respond(&f, &context);
}

/* Trucks that roll freely, heading east, in a row from west to east, with the gap of resting bodies
 * between them. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (uint32_t i = 0; i < ROWS; i++)
        fixture_put(&f,
                    (struct fixture_entity){.kind = "truck",
                                            .at = {WEST_M + 12.0 * i, FIXTURE_GROUND_M, 25000.0},
                                            .heading_rad = HALF_PI});
    begin();
    for (int n = 0; n < 60; n++)
        context.next->entities.row[1].x -= 0.5 * steps_gap(&f, &context.next->entities, 0, 1);
    nose_to_tail = context.next->entities.row[1].x - WEST_M;
    steps_respond_end(&context);
    for (uint32_t i = 0; i < ROWS; i++)
        steps_rows(&f).row[i].x = WEST_M + (nose_to_tail + CONTACT_REST_M) * i;
    fixture_state(&f).head->tick = 10;
    resting = &f.stepper.collider.resting;
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

/* Adds the rows' contact with the next row to the committed table. */
static struct persistent_contact *know(uint32_t a)
{
    struct state now = fixture_state(&f);
    struct persistent_contact *contact = &now.contacts[now.head->contact_count++];
    *contact =
        (struct persistent_contact){.a_id = a + 1, .b_id = a + 2, .a_row = a, .b_row = a + 1};
    return contact;
}

/* The mover has moved the row east at this speed. */
static void drive(uint32_t row, double speed_mps)
{
    struct entities *e = &context.next->entities;
    steps_rows(&f).row[row].vx = e->row[row].vx = speed_mps;
    e->row[row].x += speed_mps * world_dt_s(&f.view.world);
    body_motion_compute(context.motion, row);
}

static uint8_t marks(uint32_t a, uint32_t b)
{
    return context.contacts->marks[contact_queue_pair(context.contacts, &(struct pair){a, b})];
}

/* --- pushing -----------------------------------------------------------------------------------*/

static void test_a_truck_pushes_two_others_on(void **state)
{
    (void)state;
    know(0);
    know(1);
    begin();
    drive(0, 0.9);
    resting_solve(resting, &context);
    const struct entities *e = &context.next->entities;
    assert_true(fabs(e->row[0].vx + e->row[1].vx + e->row[2].vx - 0.9) < 1e-9); /* momentum */
    assert_true(e->row[2].vx > 0.2 && e->row[0].vx - e->row[1].vx < 0.01 &&
                e->row[1].vx - e->row[2].vx < 0.01);
    assert_true(steps_gap(&f, e, 0, 1) > 0.0 && steps_gap(&f, e, 1, 2) > 0.0);
    assert_int_equal(marks(0, 1), CONTACT_RESTS | CONTACT_PRESSED);
    assert_int_equal(resting->moved_count, 3);
    assert_true(fabs(context.path[2].along.x - e->row[2].vx * world_dt_s(&f.view.world)) < 1e-9);
}

/* Returns what is known of a pair. */
static const struct resting_known *rested(uint32_t a)
{
    uint32_t pair = contact_queue_pair(context.contacts, &(struct pair){a, a + 1});
    return contact_queue_rested(context.contacts, pair);
}

/* Returns the loads that the hulls of a pair bear. */
static const struct contact_load *loads(uint32_t a)
{
    return rested(a)->load;
}

static double sum_of(const struct contact_load *load)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < PERSISTENT_CONTACT_NEAREST; i++)
        sum += (double)load[i].normal_ns[0] + (double)load[i].normal_ns[1];
    return sum;
}

/* The pair remembers the impulses of its hulls, and the next frame begins with them. */
static void test_impulses_are_kept_for_the_next_frame(void **state)
{
    double mass = steps_kind(&f, "truck")->mass_kg, speed;
    struct persistent_contact *contact = know(0);
    (void)state;
    begin();
    drive(0, 0.9);
    resting_solve(resting, &context);
    speed = context.next->entities.row[1].vx;
    assert_true(fabs(sum_of(loads(0)) - mass * speed) < 1e-4 * mass);
    memcpy(contact->load, loads(0), sizeof contact->load);
    memcpy(contact->nearest, rested(0)->memory.nearest, sizeof contact->nearest);
    steps_respond_end(&context);
    steps_rows(&f).row[0].vx = 0.0;
    begin();
    resting_solve(resting, &context); /* nothing pushes: nothing may begin to move */
    assert_int_equal(resting->moved_count, 0);
    steps_respond_end(&context);
    begin();
    drive(0, 0.9);
    resting_solve(resting, &context);
    assert_true(resting->point[0].normal_ns > 0.0);
    assert_true(fabs(context.next->entities.row[1].vx - speed) < 1e-3);
    assert_true(context.next->entities.row[1].vx != speed); /* it came from elsewhere */
}

static void test_an_impact_is_left_to_the_search(void **state)
{
    (void)state;
    know(0);
    begin();
    drive(0, 1.5 * CONTACT_IMPACT_MPS);
    resting_solve(resting, &context);
    assert_int_equal(resting->pairs, 0);
    assert_int_equal(resting->moved_count, 0);
    assert_int_equal(marks(0, 1), 0);
    assert_true(context.next->entities.row[1].vx == 0.0);
}

static void test_brakes_hold_against_a_push(void **state)
{
    (void)state;
    know(0);
    steps_rows(&f).row[1].behaviour = BEHAVIOUR_IDLE; /* its driver brakes */
    begin();
    drive(0, 0.05);
    resting_solve(resting, &context);
    assert_true(fabs(context.next->entities.row[1].vx) < 1e-3);
    assert_true(fabs(context.next->entities.row[0].vx) < 1e-3);
}

static void test_bodies_that_are_far_do_not_press(void **state)
{
    (void)state;
    know(0);
    steps_rows(&f).row[0].x -= 0.5;
    begin();
    drive(0, 0.9);
    resting_solve(resting, &context);
    assert_int_equal(resting->pairs, 0);
    assert_true(context.next->entities.row[0].vx == 0.9);
}

/* --- overlaps ----------------------------------------------------------------------------------*/

static void test_an_overlap_parts_without_a_speed(void **state)
{
    double before = 0.0;
    (void)state;
    steps_rows(&f).row[1].x -= 0.02;
    know(0)->flags = PERSISTENT_CONTACT_OVERLAPS;
    begin();
    before = steps_gap(&f, &context.next->entities, 0, 1);
    resting_solve(resting, &context);
    const struct entities *e = &context.next->entities;
    double after = steps_gap(&f, e, 0, 1);
    assert_true(fabs(after - before - 0.5 * (CONTACT_REST_M - before)) < 1e-4); /* half of it */
    assert_true(e->row[0].vx == 0.0 && e->row[1].vx == 0.0 && e->row[0].spin_y == 0.0);
    assert_int_equal(marks(0, 1), CONTACT_RESTS | CONTACT_PRESSED | CONTACT_OVERLAPS);
    assert_int_equal(context.events.count, 0); /* no news */
}

/* Bodies that are nearer than bodies at rest may sleep, unless they overlap. */
static void test_a_small_gap_is_no_overlap(void **state)
{
    (void)state;
    steps_rows(&f).row[1].x -= 0.5 * CONTACT_REST_M;
    know(0)->flags = PERSISTENT_CONTACT_OVERLAPS;
    begin();
    resting_solve(resting, &context);
    assert_int_equal(marks(0, 1), CONTACT_RESTS | CONTACT_PRESSED);
}

/* Two trucks lie on their sides, with the wheels towards each other. Discs about their positions,
 * which are between the wheels, would overlap. */
static void test_who_lies_on_a_side_is_no_disc(void **state)
{
    struct entities w = steps_rows(&f);
    double half = 0.5 * steps_kind(&f, "truck")->width_m;
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        w.row[i].state = ENTITY_WRECK;
        w.row[i].heading = 0.0;
        w.row[i].x = WEST_M + half * i;
        w.row[i].y = FIXTURE_GROUND_M + half;
        w.row[i].roll = i == 0 ? -HALF_PI : HALF_PI;
    }
    know(0);
    begin();
    for (uint32_t i = 0; i < 2; i++)
        assert_true(path_change_grounded(&context, i));
    assert_true(steps_gap(&f, &w, 0, 1) > 0.5);
    drive(0, -0.1); /* or the pair would sleep */
    resting_solve(resting, &context);
    assert_int_equal(resting->pairs, 0);
    assert_int_equal(resting->moved_count, 0);
}

/* The recovery takes the second truck out of the box that the broad phase has, up to that of the
 * third. */
static void test_bodies_that_moved_find_their_new_neighbours(void **state)
{
    struct entities w = steps_rows(&f);
    bool found = false;
    (void)state;
    w.row[1].x -= 0.2;
    w.row[2].x = w.row[1].x + 2.0 * f.view.world.kinds[w.row[1].kind].bound_m +
                 2.0 * pair_filter_slack(&f.view.world) + 0.015;
    know(0)->flags = PERSISTENT_CONTACT_OVERLAPS;
    begin();
    resting_solve(resting, &context);
    for (uint32_t i = 0; i < context.contacts->pair_count; i++)
        found |= context.contacts->pair[i].a == 1 && context.contacts->pair[i].b == 2;
    assert_true(found);
    assert_true(context.next->entities.row[1].x > w.row[1].x + 0.01);
}

/* Another body had the row in the frame before, elsewhere, faster and with another heading. */
static void test_a_new_body_takes_nothing_from_its_row(void **state)
{
    struct entities w = steps_rows(&f);
    (void)state;
    w.row[1].x -= 0.02;
    begin();
    const struct entities *e = &context.next->entities;
    steps_replace(&f, &context, 1, 90);
    w.row[1].heading = 2.0;
    w.row[1].vx = 8.0;
    e->row[1].behaviour = BEHAVIOUR_IDLE;
    body_motion_compute(context.motion, 1);
    resting_solve(resting, &context);
    assert_int_equal(resting->pairs, 1);
    assert_int_equal(marks(0, 1), CONTACT_RESTS | CONTACT_PRESSED | CONTACT_OVERLAPS);
    assert_true(fabs(e->row[1].heading - HALF_PI) < 0.01);
    assert_true(fabs(e->row[1].vx) < 1e-12 && steps_gap(&f, e, 0, 1) > -0.012);
    assert_true(resting->body[1].grip_along > 0.0);
    assert_int_equal(context.events.count, 1); /* no impact will report it */
    assert_int_equal(f.view.events[context.events.first].type, EVENT_COLLISION);
}

/* The ground pushes a wreck out of itself. What it touches must not take that for a motion. */
static void test_what_the_ground_pushes_out_pushes_nothing(void **state)
{
    struct level_body body;
    struct entities *e;
    (void)state;
    begin();
    e = &context.next->entities;
    e->row[0].x += 0.04;
    e->row[0].heading += 0.01;
    body_motion_compute(context.motion, 0);
    resting_level_body(&context, 0, &body);
    assert_true(fabs(body.moved.x - 0.04 * 60.0) < 1e-9 && body.moved.spin < -0.59);
    e->row[0].state = ENTITY_WRECK;
    resting_level_body(&context, 0, &body);
    assert_true(body.moved.x == 0.0 && body.moved.z == 0.0 && body.moved.spin == 0.0);
    e->row[0].vx = 0.3; /* and this is its motion */
    resting_level_body(&context, 0, &body);
    assert_true(fabs(body.moved.x - 0.3) < 1e-9);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_a_truck_pushes_two_others_on),
        TEST(test_impulses_are_kept_for_the_next_frame),
        TEST(test_an_impact_is_left_to_the_search),
        TEST(test_brakes_hold_against_a_push),
        TEST(test_bodies_that_are_far_do_not_press),
        TEST(test_an_overlap_parts_without_a_speed),
        TEST(test_a_small_gap_is_no_overlap),
        TEST(test_who_lies_on_a_side_is_no_disc),
        TEST(test_bodies_that_moved_find_their_new_neighbours),
        TEST(test_a_new_body_takes_nothing_from_its_row),
        TEST(test_what_the_ground_pushes_out_pushes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
