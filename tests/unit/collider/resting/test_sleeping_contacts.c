/* When all contacts of the table sleep, and when the table may be kept as it is. */
#include "collider/resting/sleeping_contacts.h"

#include "collider/broad_phase/broad_phase.h"
#include "collider/narrow_phase/contact_queue.h"
#include "tests/support/steps.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"
#include "world/world.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define ROWS 4u
#define TREE (0u | PERSISTENT_CONTACT_FIXED)
#define BUSH (1u | PERSISTENT_CONTACT_FIXED)

static struct fixture f;
static struct response_context context;

/* Tanks at rest, a tree and a bush. By the table rows 0 and 1 touch each other, and row
 * 2 touches the tree. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"tree\"; at = [25140.0, 25010.0]; },"
                     "            { kind = \"bush\"; at = [25260.0, 25010.0]; } );");
    for (uint32_t i = 0; i < ROWS; i++)
        fixture_put(&f,
                    (struct fixture_entity){.kind = "tank", .at = {25000.0 + 20 * i, 100, 25000}});
    struct state now = fixture_state(&f);
    const struct entity *row = now.entities.row;
    now.head->tick = 10;
    now.head->contact_count = 2;
    now.contacts[0] = (struct persistent_contact){.a_row = 0,
                                                  .b_row = 1,
                                                  .a_id = row[0].id,
                                                  .b_id = row[1].id,
                                                  .begin_tick = 5,
                                                  .pressed_tick = 9};
    now.contacts[1] = (struct persistent_contact){.a_row = 2,
                                                  .b_row = SLOT_NONE,
                                                  .a_id = row[2].id,
                                                  .b_id = TREE,
                                                  .begin_tick = 5,
                                                  .pressed_tick = 9};
    steps_respond(&f, &context);
    struct resting_records *resting = &context.broad->resting;
    resting->never = false;
    memset(resting->awake, 0, resting->words * sizeof *resting->awake);
    memset(context.writer.written, 0, resting->words * sizeof *resting->written);
    context.contacts_sleep = true;
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

static struct persistent_contact *contact(uint32_t index)
{
    return &fixture_state(&f).contacts[index];
}

/* --- who sleeps --------------------------------------------------------------------------------*/

static void test_contacts_of_bodies_at_rest_sleep(void **state)
{
    (void)state;
    assert_true(sleeping_contacts_all(&context));
}

static void test_one_body_that_is_awake_wakes_all(void **state)
{
    (void)state;
    for (uint32_t row = 0; row < ROWS; row++) {
        context.broad->resting.awake[0] = (uint64_t)1 << row;
        assert_int_equal(sleeping_contacts_all(&context), row == 3); /* which touches nothing */
    }
}

static void test_a_contact_that_overlaps_does_not_sleep(void **state)
{
    (void)state;
    contact(0)->flags = PERSISTENT_CONTACT_OVERLAPS;
    assert_false(sleeping_contacts_all(&context));
}

/* The mover leaves the bodies where they stand. */
static void test_a_contact_that_holds_its_bodies_sleeps(void **state)
{
    (void)state;
    contact(0)->flags = PERSISTENT_CONTACT_HOLDS;
    assert_true(sleeping_contacts_all(&context));
}

static void test_a_contact_that_bears_a_load_does_not_sleep(void **state)
{
    (void)state;
    contact(1)->load[PERSISTENT_CONTACT_NEAREST - 1].friction_ns[1] = -1.0f;
    assert_false(sleeping_contacts_all(&context));
}

static void test_a_body_that_is_gone_wakes_all(void **state)
{
    (void)state;
    context.next->entities.row[1].state = ENTITY_FREE;
    assert_false(sleeping_contacts_all(&context));
}

static void test_an_object_that_has_fallen_wakes_all(void **state)
{
    (void)state;
    context.next->fixed_damage[0] = DAMAGE_DESTROYED;
    assert_false(sleeping_contacts_all(&context));
}

/* A bush lets a wreck in and does not bear it, so that the wreck moves on. */
static void test_a_wreck_in_a_bush_does_not_sleep(void **state)
{
    (void)state;
    contact(1)->b_id = BUSH;
    assert_true(sleeping_contacts_all(&context));
    context.next->entities.row[2].state = ENTITY_WRECK;
    assert_false(sleeping_contacts_all(&context));
    contact(1)->b_id = TREE;
    assert_true(sleeping_contacts_all(&context));
}

static void test_with_remote_entities_nothing_sleeps(void **state)
{
    (void)state;
    steps_params(&f)->remotes_max = 1;
    assert_false(sleeping_contacts_all(&context));
}

/* --- what is kept ------------------------------------------------------------------------------*/

static void test_a_frame_in_which_nothing_happens_keeps_the_table(void **state)
{
    (void)state;
    context.next->head->contact_count = 0;
    assert_true(sleeping_contacts_keep(&context));
    assert_int_equal(context.next->head->contact_count, 2);
    assert_memory_equal(context.next->contacts, contact(0), 2 * sizeof *contact(0));
}

static void test_what_was_awake_is_not_kept(void **state)
{
    (void)state;
    context.contacts_sleep = false;
    assert_false(sleeping_contacts_keep(&context));
}

static void test_a_change_of_a_path_wakes(void **state)
{
    (void)state;
    context.motion->changes = 1;
    assert_false(sleeping_contacts_keep(&context));
    context.motion->changes = 0;
}

/* Of the rows that responses write those that are no longer there are gone. */
static void test_the_end_of_a_body_wakes(void **state)
{
    (void)state;
    table_set_damage(&context.writer, 1, DAMAGE_HIGH);
    assert_true(sleeping_contacts_keep(&context));
    table_set_state(&context.writer, 1, ENTITY_WRECK);
    assert_false(sleeping_contacts_keep(&context));
}

static void test_damage_of_an_object_wakes(void **state)
{
    (void)state;
    context.next->head->tally.fixed_damaged++;
    assert_false(sleeping_contacts_keep(&context));
}

static void test_a_new_touch_wakes(void **state)
{
    (void)state;
    uint32_t index = contact_queue_pair(context.contacts, &(struct pair){0, 3});
    assert_true(sleeping_contacts_keep(&context));
    context.contacts->marks[index] = CONTACT_PRESSED;
    assert_false(sleeping_contacts_keep(&context));
    context.contacts->marks[index] = 0;
    context.without_room = index + 1;
    assert_false(sleeping_contacts_keep(&context));
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_contacts_of_bodies_at_rest_sleep),
        TEST(test_one_body_that_is_awake_wakes_all),
        TEST(test_a_contact_that_overlaps_does_not_sleep),
        TEST(test_a_contact_that_holds_its_bodies_sleeps),
        TEST(test_a_contact_that_bears_a_load_does_not_sleep),
        TEST(test_a_body_that_is_gone_wakes_all),
        TEST(test_an_object_that_has_fallen_wakes_all),
        TEST(test_a_wreck_in_a_bush_does_not_sleep),
        TEST(test_with_remote_entities_nothing_sleeps),
        TEST(test_a_frame_in_which_nothing_happens_keeps_the_table),
        TEST(test_what_was_awake_is_not_kept),
        TEST(test_a_change_of_a_path_wakes),
        TEST(test_the_end_of_a_body_wakes),
        TEST(test_damage_of_an_object_wakes),
        TEST(test_a_new_touch_wakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
