/* The table of persistent contacts: what it keeps from the frame before, what it renews, and which
 * contacts end. */
#include "collider/response/contact_table.h"

#include "tests/support/steps.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"

#include <string.h>

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define ROWS 6u
#define TICK 100u /* of the frame being made */

static struct fixture f;
static struct response_context context;

/* Tanks 100 m apart, and a tree. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"tree\"; at = [25000.0, 26000.0]; } );");
    for (uint32_t i = 0; i < ROWS; i++)
        fixture_put(&f,
                    (struct fixture_entity){.kind = "tank", .at = {25000.0 + 100 * i, 100, 25000}});
    fixture_state(&f).head->tick = TICK - 1;
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

/* Adds a contact to the committed table, which the caller keeps sorted. */
static struct persistent_contact *know(uint32_t a, uint32_t b, uint32_t begun, uint32_t pressed)
{
    struct state now = fixture_state(&f);
    bool fixed = b & PERSISTENT_CONTACT_FIXED;
    struct persistent_contact *contact = &now.contacts[now.head->contact_count++];
    *contact = (struct persistent_contact){.a_id = now.entities.id[a],
                                           .b_id = fixed ? b : now.entities.id[b],
                                           .a_row = a,
                                           .b_row = fixed ? SLOT_NONE : b,
                                           .begin_tick = begun,
                                           .pressed_tick = pressed};
    return contact;
}

static void press(uint32_t a, uint32_t b, uint8_t marks)
{
    uint32_t index = contact_queue_pair(context.contacts, &(struct pair){a, b});
    context.contacts->marks[index] |= CONTACT_PRESSED | marks;
}

static void move(uint32_t row)
{
    context.next->entities.x[row] += 0.25;
    body_motion_compute(context.motion, row);
}

static void begin(void)
{
    steps_respond(&f, &context);
    assert_int_equal(context.next->head->tick, TICK);
}

/* Makes the next frame's table. */
static const struct persistent_contact *finish(uint32_t count, uint32_t events)
{
    contact_table_finish(&f.stepper.collider.table, &context);
    steps_respond_end(&context);
    assert_int_equal(context.next->head->contact_count, count);
    assert_int_equal(context.events.count, events);
    return context.next->contacts;
}

static const struct event *event_of(uint32_t nth)
{
    return &f.view.events[context.events.first + nth];
}

/* --- beginning and lasting ---------------------------------------------------------------------*/

static void test_a_pair_that_presses_begins_a_contact(void **state)
{
    const struct persistent_contact right = {1, 3, 0, 2, TICK, TICK, PERSISTENT_CONTACT_OVERLAPS,
                                             0};
    (void)state;
    begin();
    press(0, 2, CONTACT_OVERLAPS);
    contact_queue_pair(context.contacts, &(struct pair){3, 4}); /* does not press */
    assert_memory_equal(finish(1, 0), &right, sizeof right);
}

static void test_a_pressed_contact_keeps_its_beginning(void **state)
{
    const struct persistent_contact right = {1, 2, 0, 1, 7, TICK, 0, 0};
    (void)state;
    know(0, 1, 7, TICK - 1)->flags = PERSISTENT_CONTACT_OVERLAPS; /* no more */
    begin();
    press(0, 1, 0);
    move(0);
    assert_memory_equal(finish(1, 0), &right, sizeof right);
}

static void test_the_list_is_sorted_by_the_pair(void **state)
{
    const uint32_t right[6][2] = {{1, 2}, {1, 5}, {1, 6}, {1, PAIR_FIXED}, {2, 3}, {4, 5}};
    (void)state;
    know(0, 1, 7, TICK - 1);
    know(0, 5, 7, TICK - 1);
    know(3, 4, 7, TICK - 1);
    begin();
    press(1, 2, 0);
    press(0, PAIR_FIXED, 0);
    press(3, 4, 0);
    press(0, 4, 0);
    const struct persistent_contact *contacts = finish(6, 0);
    for (int i = 0; i < 6; i++)
        assert_true(contacts[i].a_id == right[i][0] && contacts[i].b_id == right[i][1]);
    assert_true(contacts[3].b_row == SLOT_NONE);
}

/* The lower id comes first, whichever row it is in. */
static void test_reused_rows_are_sorted_by_their_ids(void **state)
{
    const struct persistent_contact right = {2, 50, 1, 0, TICK, TICK, 0, 0};
    (void)state;
    steps_rows(&f).id[0] = 50;
    begin();
    press(0, 1, 0);
    assert_memory_equal(finish(1, 0), &right, sizeof right);
}

static void test_two_bodies_at_rest_stay_in_contact(void **state)
{
    const struct persistent_contact right = {1, 2, 0, 1, 7, 8, 0, 0};
    (void)state;
    know(0, 1, 7, 8);
    begin();
    assert_memory_equal(finish(1, 0), &right, sizeof right);
}

/* --- what is known -----------------------------------------------------------------------------*/

static void test_known_are_the_committed_and_the_pressed(void **state)
{
    (void)state;
    know(0, 1, 7, 8);
    know(0, 5, 7, 8);
    know(2, PERSISTENT_CONTACT_FIXED, 7, 8);
    begin();
    assert_true(contact_table_knows(&context, 0, 1, 0));
    assert_true(contact_table_knows(&context, 1, 0, 0));
    assert_true(contact_table_knows(&context, 0, 5, 0));
    assert_true(contact_table_knows(&context, 2, PAIR_FIXED, 0));
    assert_false(contact_table_knows(&context, 0, 2, 0));
    assert_false(contact_table_knows(&context, 4, 5, 0));
    uint32_t pair = contact_queue_pair(context.contacts, &(struct pair){4, 5}) + 1;
    assert_false(contact_table_knows(&context, 4, 5, pair));
    press(4, 5, 0);
    assert_true(contact_table_knows(&context, 4, 5, pair));
    context.next->entities.id[1] = 60; /* another entity in the row */
    assert_false(contact_table_knows(&context, 0, 1, 0));
    steps_respond_end(&context);
}

/* --- ends --------------------------------------------------------------------------------------*/

static void test_a_body_that_moves_away_ends_the_contact_after_a_time(void **state)
{
    uint32_t lasts = (uint32_t)(CONTACT_TABLE_LASTS_S / f.view.world.params->dt_s);
    (void)state;
    know(0, 1, 70, TICK - lasts);
    know(2, 3, 70, TICK - lasts - 1);
    begin();
    move(1);
    move(2);
    const struct persistent_contact *contacts = finish(1, 1);
    assert_int_equal(contacts[0].a_id, 1);
    const struct event *event = event_of(0);
    assert_int_equal(event->type, EVENT_CONTACT_END);
    assert_true(event->contact_end.a.id == 3 && event->contact_end.b.id == 4);
    assert_true(fabs(event->contact_end.lasted_s -
                     (TICK - lasts - 1 - 70) * f.view.world.params->dt_s) < 1e-12);
}

static void test_a_body_that_is_gone_ends_its_contacts_at_once(void **state)
{
    (void)state;
    know(0, 1, 7, TICK - 1);
    know(1, 2, 7, TICK - 1);
    know(3, 4, 7, TICK - 1);
    begin();
    press(1, 2, 0); /* even if it pressed before */
    context.next->entities.state[1] = ENTITY_FREE;
    context.next->entities.id[4] = 77; /* another one in its row */
    finish(0, 3);
    assert_true(event_of(0)->contact_end.b.id == 2 && event_of(2)->contact_end.b.id == 5);
}

static void test_an_object_that_falls_ends_its_contacts(void **state)
{
    (void)state;
    know(0, PERSISTENT_CONTACT_FIXED, 7, TICK - 1);
    begin();
    context.next->fixed_damage[0] = DAMAGE_HIGH;
    finish(0, 1);
    assert_int_equal(event_of(0)->contact_end.b.id, 1);
    assert_int_equal(event_of(0)->contact_end.b.fixed, 1);
}

/* --- room --------------------------------------------------------------------------------------*/

static void test_contacts_without_room_are_counted(void **state)
{
    (void)state;
    know(0, 1, 7, TICK - 1);
    steps_params(&f)->contact_slots = 3;
    begin();
    f.stepper.collider.table.capacity = 3;
    press(4, 5, 0);
    press(3, 5, 0);
    press(2, 5, 0);
    press(1, 5, 0);
    const struct persistent_contact *contacts = finish(3, 0); /* one did not fit in either list */
    assert_int_equal(context.next->head->tally.contacts_refused, 2);
    assert_true(contacts[0].b_id == 2 && contacts[2].a_id == 4);
}

/* --- frames ------------------------------------------------------------------------------------*/

static void test_contacts_stay_as_they_are_while_paused(void **state)
{
    struct state now = fixture_state(&f);
    (void)state;
    const struct persistent_contact known = *know(0, 1, 7, 8);
    now.head->paused = 1;
    state_seal(&now, f.view.world.counts.fixed);
    fixture_run(&f, 3);
    now = fixture_state(&f);
    assert_int_equal(now.head->contact_count, 1);
    assert_memory_equal(now.contacts, &known, sizeof known);
    assert_int_equal(now.head->tick, TICK - 1);
}

/* The lists are not shared: each frame's digest is that of its own list. */
static void test_a_changed_contact_changes_the_digest_of_its_frame(void **state)
{
    (void)state;
    know(0, 1, 7, 8);
    struct state now = fixture_state(&f);
    state_seal(&now, f.view.world.counts.fixed);
    fixture_run(&f, 1);
    uint64_t before = fixture_digest(&f);
    fixture_state(&f).contacts[0].pressed_tick++;
    assert_int_not_equal(fixture_digest(&f), before);
    fixture_state(&f).contacts[0].pressed_tick--;
    f.view.w[0].contacts[0].pressed_tick++; /* frame 0's */
    assert_int_equal(fixture_digest(&f), before);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_a_pair_that_presses_begins_a_contact),
        TEST(test_a_pressed_contact_keeps_its_beginning),
        TEST(test_the_list_is_sorted_by_the_pair),
        TEST(test_reused_rows_are_sorted_by_their_ids),
        TEST(test_two_bodies_at_rest_stay_in_contact),
        TEST(test_known_are_the_committed_and_the_pressed),
        TEST(test_a_body_that_moves_away_ends_the_contact_after_a_time),
        TEST(test_a_body_that_is_gone_ends_its_contacts_at_once),
        TEST(test_an_object_that_falls_ends_its_contacts),
        TEST(test_contacts_without_room_are_counted),
        TEST(test_contacts_stay_as_they_are_while_paused),
        TEST(test_a_changed_contact_changes_the_digest_of_its_frame),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
