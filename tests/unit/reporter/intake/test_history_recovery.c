/* A new intake knows every command that its predecessor took; else one would be executed twice. */
#include "ipc/frame/command_ring.h"
#include "reporter/intake/history_recovery.h"

#include "tests/support/bare_view.h"

#include "reporter/intake/command_history.c" /* the unit tests are not linked with the processes */
#include "reporter/intake/history_recovery.c"
#include "world/entity/event.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SLOTS  8u
#define SOURCE 77u

static struct view view, collider, reporter;
static struct command_history history;

static int make_view(void **state)
{
    const struct bare_sizes sizes = {
        .capacity = 4, .event_slots = 64, .events_per_frame = 16, .command_slots = SLOTS};
    (void)state;
    bare_view_make(&view, &sizes);
    collider = bare_view_as(&view, ROLE_COLLIDER);
    reporter = bare_view_as(&view, ROLE_INTAKE);
    command_history_clear(&history, 1991);
    return 0;
}

static int drop_view(void **state)
{
    (void)state;
    segment_abandon(&view);
    return 0;
}

static void put(uint64_t first, uint64_t last)
{
    for (uint64_t i = first; i <= last; i++) {
        const struct command command = {
            .source = SOURCE, .source_sequence = i, .type = COMMAND_PAUSE};
        assert_int_equal(command_put(&reporter, RING_CLIENTS, &command), 0);
    }
}

/* Makes a frame that applies so many commands of the ring and answers them. */
static void apply(uint32_t count)
{
    struct state_head *head = bare_view_begin(&collider)->head;
    for (uint32_t i = 0; i < count; i++) {
        uint64_t at = head->command_cursor[RING_CLIENTS]++;
        const struct command *command = &view.commands[RING_CLIENTS]->slot[at & (SLOTS - 1)];
        view.events[head->event_end & 63] =
            (struct event){.sequence = head->event_end,
                           .frame = head->frame,
                           .index = i,
                           .type = EVENT_COMMAND,
                           .command = {.source = command->source,
                                       .sequence = command->source_sequence,
                                       .type = command->type,
                                       .result = COMMAND_CANNOT,
                                       .ring = RING_CLIENTS}};
        head->event_end++;
    }
    bare_view_end(&collider);
}

static struct history_entry check(uint64_t sequence, bool answered)
{
    const struct history_entry *entry = command_history_find(&history, SOURCE, sequence);
    if (!entry)
        fail_msg("command %llu is not known", (unsigned long long)sequence);
    struct history_entry found = entry ? *entry : (struct history_entry){0};
    assert_int_equal(found.answered, answered);
    return found;
}

static void test_a_world_without_commands_recalls_none(void **state)
{
    (void)state;
    assert_int_equal(history_recover(&history, &view, RING_CLIENTS), 0);
    assert_int_equal(history.oldest, 0);
}

static void test_answers_and_waiting_commands_are_known(void **state)
{
    (void)state;
    put(1, SLOTS);
    apply(SLOTS - 2);
    put(SLOTS + 1, 2 * SLOTS - 2); /* the ring has overwritten 1 .. SLOTS - 2 */
    assert_int_equal(history_recover(&history, &view, RING_CLIENTS), 0);
    for (uint64_t i = 1; i <= 2 * SLOTS - 2; i++)
        check(i, i <= SLOTS - 2);
    assert_int_equal(history.waiting, SLOTS);
    struct history_entry entry = check(1, true);
    assert_int_equal(entry.result, COMMAND_CANNOT);
    assert_int_equal(entry.frame, 1);
}

/* The next put may overwrite a command that was applied since, so it must be known. */
static void test_a_command_applied_since_is_known(void **state)
{
    (void)state;
    put(1, SLOTS);
    assert_int_equal(history_recover(&history, &view, RING_CLIENTS), 0);
    apply(1);
    put(SLOTS + 1, SLOTS + 1);
    check(1, false);
}

static void test_a_slot_that_a_kill_left_is_not_taken(void **state)
{
    (void)state;
    put(1, 2);
    apply(2);
    view.commands[RING_CLIENTS]->slot[2] =
        (struct command){.source = SOURCE, .source_sequence = 3, .type = COMMAND_PAUSE};
    assert_int_equal(history_recover(&history, &view, RING_CLIENTS), 0);
    assert_null(command_history_find(&history, SOURCE, 3));
    assert_int_equal(history.waiting, 0);
}

static void test_answers_of_other_rings_are_ignored(void **state)
{
    (void)state;
    put(1, 1);
    apply(1);
    assert_int_equal(history_recover(&history, &view, RING_RECORDER), 0);
    assert_null(command_history_find(&history, SOURCE, 1));
}

static void test_a_damaged_world_is_refused(void **state)
{
    (void)state;
    apply(0);
    view.w[1].head->frame = 7;
    assert_int_equal(history_recover(&history, &view, RING_CLIENTS), -1);
    assert_int_equal(errno, EBADMSG);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_view, drop_view)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_a_world_without_commands_recalls_none),
        TEST(test_answers_and_waiting_commands_are_known),
        TEST(test_a_command_applied_since_is_known),
        TEST(test_a_slot_that_a_kill_left_is_not_taken),
        TEST(test_answers_of_other_rings_are_ignored),
        TEST(test_a_damaged_world_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
