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
#define TICK 120u /* of the frame being made, the first of a second */

static struct fixture f;
static struct response_context context;
static uint32_t told; /* beginnings */

/* Tanks 100 m apart, and a tree. */
static int open_world(void **state)
{
    *state = &f;
    fixture_open(&f, "objects = ( { kind = \"tree\"; at = [25000.0, 26000.0]; } );");
    for (uint32_t i = 0; i < ROWS; i++)
        fixture_put(&f,
                    (struct fixture_entity){.kind = "tank", .at = {25000.0 + 100 * i, 100, 25000}});
    fixture_state(&f).head->tick = TICK - 1;
    return 0;
}

/* Adds a contact to the committed table, which the caller keeps sorted. */
static struct persistent_contact *know(uint32_t a, uint32_t b, uint32_t begun, uint32_t pressed)
{
    struct state now = fixture_state(&f);
    bool fixed = b & PERSISTENT_CONTACT_FIXED;
    struct persistent_contact *contact = &now.contacts[now.head->contact_count++];
    *contact = (struct persistent_contact){.a_id = now.entities.row[a].id,
                                           .b_id = fixed ? b : now.entities.row[b].id,
                                           .a_row = a,
                                           .b_row = fixed ? SLOT_NONE : b,
                                           .begin_tick = begun,
                                           .pressed_tick = pressed};
    return contact;
}

static void press(uint32_t a, uint32_t b, uint8_t marks)
{
    uint32_t index = contact_queue_pair(context.contacts, &(struct pair){a, b});
    if (!contact_table_find(&context, a, b) && !(context.contacts->marks[index] & CONTACT_PRESSED))
        told += contact_table_begins(&context, index + 1);
    context.contacts->marks[index] |= CONTACT_PRESSED | marks;
}

/* Gives a pair impacts in this frame. */
static void strike(uint32_t a, uint32_t b, uint32_t count, float impulse_ns)
{
    uint32_t index = contact_queue_pair(context.contacts, &(struct pair){a, b});
    press(a, b, 0);
    context.contacts->impacts[index] = (struct pair_impacts){count, impulse_ns};
}

static void move(uint32_t row)
{
    context.next->entities.row[row].x += 0.25;
    body_motion_compute(context.motion, row);
}

static void begin(void)
{
    told = 0;
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
    const uint16_t flags = PERSISTENT_CONTACT_OVERLAPS | PERSISTENT_CONTACT_HOLDS;
    const struct persistent_contact right = {1,     3, 0,    2,     TICK,        TICK,
                                             flags, 0, 0.0f, {{0}}, {{{0}, {0}}}};
    (void)state;
    begin();
    press(0, 2, CONTACT_OVERLAPS | CONTACT_HOLDS);
    contact_queue_pair(context.contacts, &(struct pair){3, 4}); /* does not press */
    assert_memory_equal(finish(1, 0), &right, sizeof right);
}

static void test_a_pressed_contact_keeps_its_beginning(void **state)
{
    const struct persistent_contact right = {1, 2, 0, 1, 7, TICK, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}};
    (void)state;
    know(0, 1, 7, TICK - 1)->flags = PERSISTENT_CONTACT_OVERLAPS; /* no more */
    begin();
    press(0, 1, 0);
    move(0);
    assert_memory_equal(finish(1, 0), &right, sizeof right);
}

/* Returns what is known of a pair. */
static struct resting_known *rested(uint32_t a, uint32_t b)
{
    uint32_t pair = contact_queue_pair(context.contacts, &(struct pair){a, b});
    return contact_queue_rested(context.contacts, pair);
}

/* The next frame's search for the nearest points begins with what this one remembers. */
static void test_what_the_hulls_remember_is_kept(void **state)
{
    const struct nearest_vertices nearest = {9, 2, {1, 2, 0}, {3, 4, 0}};
    struct persistent_contact right = {1, 2, 0, 1, 7, TICK, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}};
    (void)state;
    right.nearest[1] = nearest;
    know(0, 1, 7, TICK - 1)->nearest[0] = nearest; /* of the frame before */
    begin();
    press(0, 1, 0);
    rested(0, 1)->memory.nearest[1] = nearest;
    move(0);
    assert_memory_equal(finish(1, 0), &right, sizeof right);
}

/* The next frame's solver begins with the impulses of this one, and with none of earlier ones. */
static void test_what_the_hulls_bear_is_kept_for_a_frame(void **state)
{
    const struct contact_load load = {{3.0f, 4.0f}, {-1.0f, 2.0f}};
    const struct contact_load none = {{0.0f, 0.0f}, {0.0f, 0.0f}};
    (void)state;
    know(0, 1, 7, TICK - 1)->load[1] = load;
    know(2, 3, 7, TICK - 1)->load[0] = load;
    begin();
    press(0, 1, 0);
    rested(0, 1)->load[2] = load;
    const struct persistent_contact *contacts = finish(2, 0);
    assert_memory_equal(&contacts[0].load[1], &none, sizeof none);
    assert_memory_equal(&contacts[0].load[2], &load, sizeof load);
    assert_memory_equal(&contacts[1].load[0], &none, sizeof none);
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
    const struct persistent_contact right = {2, 50, 1,    0,     TICK,        TICK,
                                             0, 0,  0.0f, {{0}}, {{{0}, {0}}}};
    (void)state;
    steps_rows(&f).row[0].id = 50;
    begin();
    press(0, 1, 0);
    assert_memory_equal(finish(1, 0), &right, sizeof right);
}

static void test_two_bodies_at_rest_stay_in_contact(void **state)
{
    const struct persistent_contact right = {1, 2, 0, 1, 7, 8, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}};
    (void)state;
    know(0, 1, 7, 8);
    begin();
    assert_memory_equal(finish(1, 0), &right, sizeof right);
}

static void test_impacts_add_up(void **state)
{
    (void)state;
    *know(0, 1, 7, TICK - 1) =
        (struct persistent_contact){1, 2, 0, 1, 7, TICK - 1, 0, 3, 5.0f, {{0}}, {{{0}, {0}}}};
    *know(0, 3, 7, TICK - 1) =
        (struct persistent_contact){1, 4, 0, 3, 7, TICK - 1, 0, 65535, 0.0f, {{0}}, {{{0}, {0}}}};
    begin();
    strike(0, 1, 2, 6.0f);
    strike(0, 2, 1, 7.0f);
    strike(0, 3, 1, 8.0f);
    const struct persistent_contact *contacts = finish(3, 0);
    assert_true(contacts[0].impacts == 5 && contacts[0].impulse_ns == 11.0f);
    assert_true(contacts[1].impacts == 1 && contacts[1].impulse_ns == 7.0f);
    assert_true(contacts[2].impacts == 65535 && contacts[2].impulse_ns == 8.0f);
}

/* --- what is known -----------------------------------------------------------------------------*/

static void test_known_are_the_committed(void **state)
{
    (void)state;
    const struct persistent_contact *first = fixture_state(&f).contacts;
    know(0, 1, 7, 8);
    know(0, 5, 7, 8);
    know(2, PERSISTENT_CONTACT_FIXED, 7, 8);
    begin();
    assert_ptr_equal(contact_table_find(&context, 0, 1), first);
    assert_ptr_equal(contact_table_find(&context, 1, 0), first);
    assert_ptr_equal(contact_table_find(&context, 0, 5), first + 1);
    assert_ptr_equal(contact_table_find(&context, 2, PAIR_FIXED), first + 2);
    assert_null(contact_table_find(&context, 0, 2));
    assert_null(contact_table_find(&context, 4, 5));
    context.next->entities.row[1].id = 60; /* another entity in the row */
    assert_null(contact_table_find(&context, 0, 1));
    steps_respond_end(&context);
}

/* --- ends --------------------------------------------------------------------------------------*/

static void test_a_body_that_moves_away_ends_the_contact_after_a_time(void **state)
{
    uint32_t lasts = (uint32_t)(CONTACT_TABLE_LASTS_S / f.view.world.params->dt_s);
    (void)state;
    know(0, 1, 70, TICK - lasts);
    know(2, 3, 70, TICK - lasts - 1)->impacts = 4;
    fixture_state(&f).contacts[1].impulse_ns = 9.0f;
    begin();
    move(1);
    move(2);
    const struct persistent_contact *contacts = finish(1, 1);
    assert_int_equal(contacts[0].a_id, 1);
    const struct event *event = event_of(0);
    assert_int_equal(event->type, EVENT_CONTACT_END);
    assert_true(event->contact_end.a.id == 3 && event->contact_end.b.id == 4);
    assert_true(event->contact_end.impacts == 4 && event->contact_end.impulse_ns == 9.0f);
    assert_int_equal(event->contact_end.because, CONTACT_END_PARTED);
    assert_true(fabs(event->contact_end.lasted_s -
                     (TICK - lasts - 1 - 70) * f.view.world.params->dt_s) < 1e-12);
}

/* However long ago they bore a load. */
static void test_bodies_that_still_touch_stay_in_contact(void **state)
{
    uint32_t lasts = (uint32_t)(CONTACT_TABLE_LASTS_S / f.view.world.params->dt_s);
    (void)state;
    know(0, 1, 70, TICK - lasts - 1);
    begin();
    context.next->entities.row[1].x = context.next->entities.row[0].x + 1.0;
    body_motion_compute(context.motion, 1);
    assert_int_equal(finish(1, 0)[0].pressed_tick, TICK);
}

/* Bodies that have not touched for long end their contact only when they are far enough apart. */
static void test_bodies_that_are_near_stay_in_contact(void **state)
{
    uint32_t lasts = (uint32_t)(CONTACT_TABLE_LASTS_S / f.view.world.params->dt_s);
    struct vec3 at[2];
    (void)state;
    steps_params(&f)->collision.shape = SHAPE_SPHERE;
    know(0, 1, 70, TICK - lasts - 1);
    know(2, 3, 70, TICK - lasts - 1);
    begin();
    double reach = 2.0 * pair_filter_row_reach(&context.input.detect, 0);
    for (uint32_t i = 0; i < 2; i++) {
        double gap = CONTACT_TABLE_PARTED_M + (i == 0 ? -1e-3 : 1e-3);
        at[i] = entities_position(&context.next->entities, 2 * i);
        context.next->entities.row[2 * i + 1].x = at[i].x + reach + gap;
        body_motion_compute(context.motion, 2 * i + 1);
    }
    const struct persistent_contact *contact = finish(1, 1);
    assert_true(contact->a_id == 1 && contact->pressed_tick == TICK - lasts - 1);
    assert_int_equal(event_of(0)->contact_end.because, CONTACT_END_PARTED);
}

static void test_a_body_that_is_gone_ends_its_contacts_at_once(void **state)
{
    (void)state;
    know(0, 1, 7, TICK - 1);
    know(1, 2, 7, TICK - 1);
    know(3, 4, 7, TICK - 1);
    begin();
    press(1, 2, 0); /* even if it pressed before */
    context.next->entities.row[1].state = ENTITY_FREE;
    context.next->entities.row[4].id = 77; /* another one in its row */
    finish(0, 3);
    assert_true(event_of(0)->contact_end.b.id == 2 && event_of(2)->contact_end.b.id == 5);
    assert_int_equal(event_of(0)->contact_end.because, CONTACT_END_GONE);
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

/* Two contacts are known, and there is room for a third. */
static void press_four(void)
{
    know(0, 5, 7, TICK - 1);
    know(2, 3, 7, TICK - 1);
    steps_params(&f)->contact_slots = 3;
    begin();
    f.stepper.collider.table.capacity = 1; /* its own lists grow */
}

/* Known contacts keep their room, and the first new one takes what is left. Those without room are
 * counted. In the first frame of a second one of them is told. */
static void test_contacts_without_room_are_counted(void **state)
{
    (void)state;
    press_four();
    press(4, 5, 0);
    strike(1, 5, 2, 6.0f);
    press(3, 5, 0);
    press(2, 5, 0);
    press(2, 3, 0);
    context.next->entities.row[5].damage = DAMAGE_HIGH; /* in this frame */
    const struct persistent_contact *contacts = finish(3, 1);
    assert_int_equal(context.next->head->tally.contacts_refused, 3);
    assert_int_equal(told, 2);
    assert_true(contacts[0].b_id == 6 && contacts[1].a_id == 3 && contacts[2].a_id == 5);
    const struct event_contact_end *end = &event_of(0)->contact_end;
    assert_int_equal(end->because, CONTACT_END_NO_ROOM);
    assert_true(end->a.id == 2 && end->b.id == 6 && end->b.damage == DAMAGE_HIGH);
    assert_true(end->impacts == 2 && end->impulse_ns == 6.0f);
}

static void test_in_the_rest_of_a_second_none_without_room_is_told(void **state)
{
    (void)state;
    press_four();
    context.next->head->tick++;
    press(4, 5, 0);
    press(1, 5, 0);
    press(2, 5, 0);
    finish(3, 0);
    assert_int_equal(context.next->head->tally.contacts_refused, 2);
    assert_int_equal(told, 1);
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
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, fixture_teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_a_pair_that_presses_begins_a_contact),
        TEST(test_a_pressed_contact_keeps_its_beginning),
        TEST(test_what_the_hulls_remember_is_kept),
        TEST(test_what_the_hulls_bear_is_kept_for_a_frame),
        TEST(test_the_list_is_sorted_by_the_pair),
        TEST(test_reused_rows_are_sorted_by_their_ids),
        TEST(test_two_bodies_at_rest_stay_in_contact),
        TEST(test_impacts_add_up),
        TEST(test_known_are_the_committed),
        TEST(test_a_body_that_moves_away_ends_the_contact_after_a_time),
        TEST(test_bodies_that_still_touch_stay_in_contact),
        TEST(test_bodies_that_are_near_stay_in_contact),
        TEST(test_a_body_that_is_gone_ends_its_contacts_at_once),
        TEST(test_an_object_that_falls_ends_its_contacts),
        TEST(test_contacts_without_room_are_counted),
        TEST(test_in_the_rest_of_a_second_none_without_room_is_told),
        TEST(test_contacts_stay_as_they_are_while_paused),
        TEST(test_a_changed_contact_changes_the_digest_of_its_frame),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
