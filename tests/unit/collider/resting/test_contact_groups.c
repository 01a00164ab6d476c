/* Which contacts of the table are looked at: those of groups in which something moves. */
#include "collider/resting/contact_groups.h"

#include "tests/support/steps.h"
#include "world/entity/persistent_contact.h"
#include "world/world.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define ROWS 8u

static struct fixture f;
static struct response_context context;
static struct contact_groups *groups;

/* A row of tanks 20 m apart, a tree before the last, and a bush at the end. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"tree\"; at = [25140.0, 25010.0]; },"
                     "            { kind = \"bush\"; at = [25260.0, 25010.0]; } );");
    for (uint32_t i = 0; i < ROWS; i++)
        fixture_put(&f,
                    (struct fixture_entity){.kind = "tank", .at = {25000.0 + 20 * i, 100, 25000}});
    fixture_state(&f).head->tick = 10; /* nothing is new */
    groups = &f.stepper.collider.resting.groups;
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

/* Adds a contact of two rows to the committed table. b may be a fixed object. */
static struct persistent_contact *press(uint32_t a, uint32_t b)
{
    struct state now = fixture_state(&f);
    const struct entity *row = now.entities.row;
    bool fixed = b & PERSISTENT_CONTACT_FIXED, swap = !fixed && row[b].id < row[a].id;
    struct persistent_contact *contact = &now.contacts[now.head->contact_count++];
    *contact = (struct persistent_contact){.a_row = swap ? b : a,
                                           .b_row = fixed  ? SLOT_NONE
                                                    : swap ? a
                                                           : b,
                                           .begin_tick = 5,
                                           .pressed_tick = 9};
    contact->a_id = row[contact->a_row].id;
    contact->b_id = fixed ? b : row[contact->b_row].id;
    return contact;
}

/* Two chains: 0 - 1 - 2 and 4 - 5. */
static void press_chains(void)
{
    press(0, 1);
    press(1, 2);
    press(4, 5);
}

static void move(uint32_t row)
{
    context.next->entities.row[row].x += 0.25;
    body_motion_compute(context.motion, row);
}

static bool is_pair(uint32_t index, uint32_t a, uint32_t b)
{
    return groups->pair[index].a == a && groups->pair[index].b == b;
}

/* --- groups ------------------------------------------------------------------------------------*/

static void test_a_group_in_which_nothing_moves_is_left_out(void **state)
{
    (void)state;
    press_chains();
    steps_respond(&f, &context);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 0);
    assert_int_equal(groups->stirred_count, 0);
}

static void test_one_mover_wakes_all_of_its_group(void **state)
{
    (void)state;
    press_chains();
    for (uint32_t mover = 0; mover < 3; mover++) {
        steps_respond(&f, &context);
        move(mover);
        contact_groups_find(groups, &context);
        assert_int_equal(groups->count, 2);
        assert_int_equal(groups->known, 2);
        assert_int_equal(groups->stirred_count, 2);
        assert_true(is_pair(0, 0, 1) && is_pair(1, 1, 2));
        steps_respond_end(&context);
    }
}

/* The solver reads the path of every row of the pairs. One that was left over from an earlier frame
 * would be right nearly always, but not in a process that has just begun. */
static void test_the_paths_of_all_rows_are_computed(void **state)
{
    (void)state;
    press_chains();
    steps_respond(&f, &context);
    memset(context.motion->computed, 0, ROWS * sizeof *context.motion->computed);
    context.next->entities.row[4].x += 0.25;
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 1);
    assert_true(context.motion->computed[4] && context.motion->computed[5]);
}

static void test_the_frame_before_leaves_no_trace(void **state)
{
    (void)state;
    press_chains();
    steps_respond(&f, &context);
    move(0);
    move(4);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 3);
    steps_respond_end(&context);
    fixture_state(&f).head->contact_count = 0;
    press(2, 3);
    press(5, 6);
    steps_respond(&f, &context);
    move(3);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 1);
    assert_true(is_pair(0, 2, 3));
}

static void test_two_movers_wake_two_groups(void **state)
{
    (void)state;
    press_chains();
    steps_respond(&f, &context);
    move(2);
    move(4);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 3);
    assert_true(is_pair(0, 0, 1) && is_pair(1, 1, 2) && is_pair(2, 4, 5));
}

/* A fixed object joins nothing: a body that leans on it does not wake another one there. */
static void test_a_fixed_object_joins_no_groups(void **state)
{
    (void)state;
    press(6, PERSISTENT_CONTACT_FIXED);
    press(7, PERSISTENT_CONTACT_FIXED);
    steps_respond(&f, &context);
    move(7);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 1);
    assert_true(is_pair(0, 7, PAIR_FIXED));
}

static void test_an_overlap_wakes_its_group(void **state)
{
    (void)state;
    press_chains();
    fixture_state(&f).contacts[1].flags = PERSISTENT_CONTACT_OVERLAPS;
    steps_respond(&f, &context);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 2);
}

/* The lower id is in the higher row, because that row is older. */
static void test_an_overlap_wakes_a_group_in_reused_rows(void **state)
{
    (void)state;
    steps_rows(&f).row[0].id = 50;
    press(0, 1)->flags = PERSISTENT_CONTACT_OVERLAPS;
    steps_respond(&f, &context);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 1);
    assert_true(is_pair(0, 0, 1));
}

/* --- bodies that a contact holds ---------------------------------------------------------------*/

/* The springs of row 1, which stands partly on row 0, tilt it in the next frame, as they did in the
 * frame before. */
static void tilt(double spin_rps)
{
    press(0, 1)->flags = PERSISTENT_CONTACT_HOLDS;
    steps_rows(&f).row[1].flags |= ENTITY_FLAG_CHASSIS;
    steps_respond(&f, &context);
    context.next->entities.row[1].roll += spin_rps * world_dt_s(context.world);
    context.next->entities.row[1].spin_x = spin_rps;
    context.next->entities.row[1].x += 1e-5;
    body_motion_compute(context.motion, 1);
}

static void test_a_group_that_its_contacts_hold_sleeps(void **state)
{
    (void)state;
    tilt(0.02);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 0);
    assert_true(context.next->entities.row[1].roll == steps_rows(&f).row[1].roll);
    assert_true(context.next->entities.row[1].x == steps_rows(&f).row[1].x);
    assert_true(context.next->entities.row[1].spin_x == 0.0);
    assert_false(body_motion_moves(context.motion, 1));
}

static void assert_wakes(void)
{
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 1);
    assert_true(context.next->entities.row[1].spin_x != 0.0);
}

static void test_a_held_body_that_falls_wakes_its_group(void **state)
{
    (void)state;
    tilt(0.02);
    context.next->entities.row[1].vy = -9.8 * world_dt_s(context.world);
    assert_wakes();
}

static void test_a_held_body_that_is_driven_wakes_its_group(void **state)
{
    (void)state;
    tilt(0.02);
    context.next->entities.row[1].vz = -1.0 * world_dt_s(context.world);
    assert_wakes();
}

static void test_a_held_body_that_tips_over_wakes_its_group(void **state)
{
    (void)state;
    tilt(5.0 * world_dt_s(&f.view.world));
    assert_wakes();
}

/* What rests on a body that moves is no longer held as it was. */
static void test_a_neighbour_wakes_a_held_body(void **state)
{
    (void)state;
    tilt(0.02);
    move(0);
    assert_wakes();
}

static void test_what_no_contact_holds_moves(void **state)
{
    (void)state;
    tilt(0.02);
    fixture_state(&f).contacts[0].flags = 0;
    assert_wakes();
}

/* --- what is no resting contact ----------------------------------------------------------------*/

static void test_bodies_that_are_gone_are_left_out(void **state)
{
    (void)state;
    press_chains();
    press(6, PERSISTENT_CONTACT_FIXED);
    steps_respond(&f, &context);
    move(0);
    move(2);
    move(6);
    context.next->entities.row[1].state = ENTITY_FREE;
    context.next->fixed_damage[0] = DAMAGE_HIGH;
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 0);
    context.next->entities.row[1].state = ENTITY_ACTIVE;
    context.next->fixed_damage[0] = DAMAGE_NONE;
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 3);
}

/* Vehicles drive through bushes: they bear no load. */
static void test_a_bush_is_no_wall(void **state)
{
    (void)state;
    press(6, PERSISTENT_CONTACT_FIXED | 1);
    press(7, PERSISTENT_CONTACT_FIXED);
    steps_respond(&f, &context);
    move(6);
    move(7);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 1);
    assert_true(is_pair(0, 7, PAIR_FIXED));
    assert_true(contact_groups_is_wall(&context, 0) && !contact_groups_is_wall(&context, 1));
}

static void test_bodies_in_the_air_are_left_out(void **state)
{
    (void)state;
    press_chains();
    steps_rows(&f).row[2].kind = fixture_kind(&f, "helicopter");
    steps_respond(&f, &context);
    move(2);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 0);
}

/* --- bodies that are new -----------------------------------------------------------------------*/

/* Row 3 stands in row 2, and another entity had the row in the frame before. */
static void test_a_new_body_that_overlaps_is_found(void **state)
{
    (void)state;
    steps_rows(&f).row[3].x = 25041.0;
    steps_respond(&f, &context);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->count, 0); /* an old one is not */
    steps_respond_end(&context);
    steps_respond(&f, &context);
    steps_replace(&f, &context, 3, 90);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->known, 0);
    assert_int_equal(groups->count, 1);
    assert_true(is_pair(0, 2, 3));
}

static void test_two_new_bodies_are_one_pair(void **state)
{
    (void)state;
    steps_rows(&f).row[3].x = 25041.0;
    press(0, 1);
    steps_respond(&f, &context);
    move(0);
    steps_replace(&f, &context, 2, 91);
    steps_replace(&f, &context, 3, 90);
    contact_groups_find(groups, &context);
    assert_int_equal(groups->known, 1);
    assert_int_equal(groups->count, 2);
    assert_true(is_pair(0, 0, 1) && is_pair(1, 2, 3));
}

/* --- free bodies -------------------------------------------------------------------------------*/

static void make_wreck(uint32_t row, double up_m)
{
    struct entities e = steps_rows(&f);
    e.row[row].state = ENTITY_WRECK;
    e.row[row].y += up_m;
    e.row[row].until_tick = 3; /* at rest */
}

static void test_a_wreck_above_the_ground_is_free(void **state)
{
    (void)state;
    make_wreck(1, 2.0);
    press(0, 1);
    press(2, 3);
    steps_respond(&f, &context);
    move(0);
    move(2);
    contact_groups_find(groups, &context);
    assert_true(groups->count == 1 && is_pair(0, 2, 3));
    contact_groups_find_free(groups, &context);
    assert_true(groups->count == 1 && is_pair(0, 0, 1));
    assert_true(contact_groups_is_free(&context, 1) && !contact_groups_is_free(&context, 0));
}

/* A held body has no weight: one that rocks would lift what lies on it. */
static void test_a_wreck_that_rocks_is_free(void **state)
{
    (void)state;
    make_wreck(1, 0.0);
    steps_respond(&f, &context);
    const struct entities *e = &context.next->entities;
    assert_false(contact_groups_is_free(&context, 1));
    e->row[1].vx = 3.0; /* it slides */
    assert_false(contact_groups_is_free(&context, 1));
    e->row[1].vy = 0.06;
    assert_true(contact_groups_is_free(&context, 1));
    e->row[1].vy = 0.0;
    context.motion->before.row[1].spin_x = e->row[1].spin_x = 0.02; /* its ends: 7 cm/s */
    assert_true(contact_groups_is_free(&context, 1));
}

static void test_a_wreck_wakes_when_what_it_leans_on_is_gone(void **state)
{
    (void)state;
    make_wreck(1, 2.0);
    press(0, 1);
    steps_respond(&f, &context);
    contact_groups_find_free(groups, &context);
    assert_int_equal(context.next->entities.row[1].until_tick, 3);
    context.next->entities.row[0].state = ENTITY_FREE;
    contact_groups_find_free(groups, &context);
    assert_int_equal(context.next->entities.row[1].until_tick, 0);
    assert_int_equal(groups->count, 0);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_a_group_in_which_nothing_moves_is_left_out),
        TEST(test_one_mover_wakes_all_of_its_group),
        TEST(test_the_paths_of_all_rows_are_computed),
        TEST(test_the_frame_before_leaves_no_trace),
        TEST(test_two_movers_wake_two_groups),
        TEST(test_a_fixed_object_joins_no_groups),
        TEST(test_an_overlap_wakes_its_group),
        TEST(test_an_overlap_wakes_a_group_in_reused_rows),
        TEST(test_a_group_that_its_contacts_hold_sleeps),
        TEST(test_a_held_body_that_falls_wakes_its_group),
        TEST(test_a_held_body_that_is_driven_wakes_its_group),
        TEST(test_a_held_body_that_tips_over_wakes_its_group),
        TEST(test_a_neighbour_wakes_a_held_body),
        TEST(test_what_no_contact_holds_moves),
        TEST(test_bodies_that_are_gone_are_left_out),
        TEST(test_a_bush_is_no_wall),
        TEST(test_bodies_in_the_air_are_left_out),
        TEST(test_a_new_body_that_overlaps_is_found),
        TEST(test_two_new_bodies_are_one_pair),
        TEST(test_a_wreck_above_the_ground_is_free),
        TEST(test_a_wreck_that_rocks_is_free),
        TEST(test_a_wreck_wakes_when_what_it_leans_on_is_gone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
