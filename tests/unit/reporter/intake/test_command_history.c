/* The history of commands: each key once, answers kept, the oldest overwritten first. */
#include "reporter/intake/command_history.c" /* the unit tests are not linked with the processes */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct command_history history;

/* Returns the entry, which must exist. */
static struct history_entry entry_of(uint64_t source, uint64_t sequence)
{
    const struct history_entry *entry = command_history_find(&history, source, sequence);
    if (!entry)
        fail_msg("no entry of (%llu, %llu)", (unsigned long long)source,
                 (unsigned long long)sequence);
    return entry ? *entry : (struct history_entry){0};
}

static void test_waits_until_answered(void **state)
{
    (void)state;
    command_history_clear(&history, 1991);
    assert_null(command_history_find(&history, 7, 1));
    command_history_wait(&history, 7, 1, 9, 0);
    assert_int_equal(history.waiting, 1);
    assert_false(entry_of(7, 1).answered);
    assert_null(command_history_find(&history, 7, 2));
    assert_null(command_history_find(&history, 8, 1));

    const struct history_entry *entry = command_history_answer(&history, 7, 1, 9, 0, 501, 1300);
    assert_ptr_equal(entry, command_history_find(&history, 7, 1));
    assert_true(entry->answered);
    assert_int_equal(entry->type, 9);
    assert_int_equal(entry->entity, 501);
    assert_int_equal(entry->frame, 1300);
    assert_int_equal(history.waiting, 0);
}

static void test_a_repeat_changes_nothing(void **state)
{
    (void)state;
    command_history_clear(&history, 1991);
    command_history_wait(&history, 7, 1, 9, 0);
    command_history_wait(&history, 7, 1, 9, 0);
    assert_int_equal(history.waiting, 1);
    (void)command_history_answer(&history, 7, 1, 9, 3, 0, 10);
    command_history_wait(&history, 7, 1, 9, 0);
    assert_int_equal(history.waiting, 0);
    assert_true(entry_of(7, 1).answered);
    assert_int_equal(entry_of(7, 1).result, 3);
    (void)command_history_answer(&history, 7, 1, 9, 3, 0, 10); /* the event ring is read again */
    assert_int_equal(history.waiting, 0);
}

static void test_an_answer_to_an_unknown_command_is_kept(void **state)
{
    (void)state;
    command_history_clear(&history, 1991);
    (void)command_history_answer(&history, 99, 5, 1, 0, 0, 42);
    assert_int_equal(history.waiting, 0);
    assert_int_equal(entry_of(99, 5).frame, 42);
}

/* Fills the history three times, half of it answered. It always holds the last HISTORY_ENTRIES. */
static void test_forgets_the_oldest(void **state)
{
    (void)state;
    command_history_clear(&history, 1991);
    for (uint64_t i = 1; i <= 3 * HISTORY_ENTRIES; i++) {
        uint64_t source = i % 5 + 1; /* few sources, whose chains a poor hash would make long */
        command_history_wait(&history, source, i, 1, 0);
        if (i % 2)
            (void)command_history_answer(&history, source, i, 1, 0, (uint32_t)i, i);
        assert_non_null(command_history_find(&history, source, i));
        if (i > HISTORY_ENTRIES)
            assert_null(
                command_history_find(&history, (i - HISTORY_ENTRIES) % 5 + 1, i - HISTORY_ENTRIES));
    }
    assert_int_equal(history.waiting, HISTORY_ENTRIES / 2);
    for (uint64_t i = 2 * HISTORY_ENTRIES + 1; i <= 3 * HISTORY_ENTRIES; i++) {
        assert_int_equal(entry_of(i % 5 + 1, i).answered, i % 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_waits_until_answered),
        cmocka_unit_test(test_a_repeat_changes_nothing),
        cmocka_unit_test(test_an_answer_to_an_unknown_command_is_kept),
        cmocka_unit_test(test_forgets_the_oldest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
