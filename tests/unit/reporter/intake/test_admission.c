/* Admission: order of service, budgets and reserved slots, in virtual time. */
#include "reporter/intake/admission.c" /* the unit tests are not linked with the processes */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SECOND 1000000000u

static struct admission admission;

static void put(uint32_t place, jolon_CommandType type, uint64_t sequence)
{
    const jolon_Command command = {.type = type, .sequence = sequence, .source = place + 1};
    assert_true(admission_room(&admission, place));
    admission_put(&admission, place, &command);
}

static void fill(uint32_t place, jolon_CommandType type)
{
    while (admission_room(&admission, place))
        put(place, type, 1);
}

/* Takes the commands that may go now, at most `most`. Returns how many were of the client. */
static uint32_t take_of_client(uint64_t client, uint32_t most, uint64_t now_ns)
{
    jolon_Command command;
    uint64_t from;
    uint32_t count = 0;
    for (uint32_t i = 0;
         i < most && admission_take(&admission, &(struct admission_world){.untaken = i}, now_ns,
                                    &command, &from);
         i++)
        count += from == client;
    return count;
}

static int set_up(void **state)
{
    (void)state;
    admission = (struct admission){0};
    for (uint32_t i = 0; i < 3; i++)
        admission_enter(&admission, i, 100 + i);
    return 0;
}

static void test_sources_are_served_in_turn(void **state)
{
    (void)state;
    fill(0, jolon_COMMAND_DRIVE);
    put(1, jolon_COMMAND_DRIVE, 7);
    jolon_Command command;
    uint64_t client;
    assert_true(admission_take(&admission, &(struct admission_world){.untaken = 0}, SECOND,
                               &command, &client));
    assert_int_equal(client, 100);
    assert_true(admission_take(&admission, &(struct admission_world){.untaken = 1}, SECOND,
                               &command, &client));
    assert_int_equal(client, 101); /* although the first source has 15 more */
    assert_int_equal(command.sequence, 7);
    assert_int_equal(take_of_client(100, 100, SECOND), ADMISSION_QUEUE - 1);
    assert_false(admission_waiting(&admission));
}

static void test_a_source_keeps_its_order(void **state)
{
    (void)state;
    for (uint64_t i = 1; i <= ADMISSION_QUEUE; i++)
        put(2, jolon_COMMAND_DRIVE, i);
    assert_false(admission_room(&admission, 2));
    for (uint64_t i = 1; i <= ADMISSION_QUEUE; i++) {
        jolon_Command command;
        uint64_t client;
        assert_true(admission_take(&admission, &(struct admission_world){.untaken = 0}, SECOND,
                                   &command, &client));
        assert_int_equal(command.sequence, i);
    }
}

static void test_a_flood_is_held_to_its_budget(void **state)
{
    (void)state;
    uint32_t taken = 0;
    for (uint64_t ms = 0; ms < 2000; ms++) {
        fill(0, jolon_COMMAND_DRIVE);
        taken += take_of_client(100, 16, SECOND + ms * 1000000u);
    }
    assert_in_range(taken, 2 * ADMISSION_COMMANDS_PER_S,
                    2 * ADMISSION_COMMANDS_PER_S + ADMISSION_COMMANDS_BURST + 1);
}

static void test_spawns_have_a_budget_for_one_and_for_all(void **state)
{
    (void)state;
    uint32_t one = 0, all = 0;
    for (uint64_t ms = 0; ms < 1000; ms++) {
        for (uint32_t i = 0; i < 3; i++)
            fill(i, jolon_COMMAND_SPAWN);
        jolon_Command command;
        uint64_t client;
        while (admission_take(&admission, &(struct admission_world){.untaken = 0},
                              SECOND + ms * 1000000u, &command, &client)) {
            one += client == 100;
            all++;
        }
    }
    assert_in_range(one, 25, ADMISSION_COSTLY_PER_S + ADMISSION_COSTLY_BURST + 1);
    assert_in_range(all, ADMISSION_ALL_COSTLY_PER_S,
                    ADMISSION_ALL_COSTLY_PER_S + ADMISSION_ALL_COSTLY_BURST + 1);
    /* A command that waits for the budget of spawns does not delay other sources. */
    admission_enter(&admission, 3, 103);
    put(3, jolon_COMMAND_DRIVE, 1);
    assert_int_equal(take_of_client(103, 16, 2 * (uint64_t)SECOND), 1);
}

static void test_operators_go_first_and_have_reserved_slots(void **state)
{
    (void)state;
    jolon_Command command;
    uint64_t client;
    fill(0, jolon_COMMAND_DRIVE);
    put(1, jolon_COMMAND_PAUSE, 1);
    assert_true(admission_take(&admission, &(struct admission_world){.untaken = 0}, SECOND,
                               &command, &client));
    assert_int_equal(command.type, jolon_COMMAND_PAUSE);
    assert_false(admission_take(&admission,
                                &(struct admission_world){.untaken = ADMISSION_RING_ROOM}, SECOND,
                                &command, &client));
    put(1, jolon_COMMAND_QUIT, 2);
    assert_true(admission_take(&admission,
                               &(struct admission_world){.untaken = ADMISSION_RING_ROOM}, SECOND,
                               &command, &client));
    assert_int_equal(command.type, jolon_COMMAND_QUIT);
    put(1, jolon_COMMAND_REMOVE, 3);
    assert_false(admission_take(&admission,
                                &(struct admission_world){.untaken = ADMISSION_RING_ROOM_OPERATOR},
                                SECOND, &command, &client));
}

static void test_a_strained_world_gets_few_costly_commands(void **state)
{
    (void)state;
    const struct admission_world strained = {.strained = true};
    jolon_Command command;
    uint64_t client;
    uint32_t spawns = 0, of_another = 0;
    for (uint64_t ms = 0; ms < 10000; ms++) {
        fill(0, jolon_COMMAND_SPAWN);
        if (admission_room(&admission, 1))
            put(1, jolon_COMMAND_SPAWN, 1);
        while (admission_take(&admission, &strained, SECOND + ms * 1000000u, &command, &client)) {
            spawns++;
            of_another += client == 101;
        }
    }
    assert_in_range(spawns, 10 * ADMISSION_STRAINED_PER_S,
                    10 * ADMISSION_STRAINED_PER_S + ADMISSION_STRAINED_BURST);
    assert_in_range(of_another, spawns * 2 / 5,
                    spawns * 3 / 5); /* the sources are served in turn */
    put(2, jolon_COMMAND_DRIVE, 1);
    assert_true(admission_take(&admission, &strained, 12 * (uint64_t)SECOND, &command, &client));
    put(2, jolon_COMMAND_DRIVE, 2);
    do { /* drives are not limited */
        assert_true(
            admission_take(&admission, &strained, 12 * (uint64_t)SECOND, &command, &client));
    } while (client != 102);
}

static void test_a_freed_source_is_empty(void **state)
{
    (void)state;
    fill(0, jolon_COMMAND_DRIVE);
    admission_leave(&admission, 0);
    assert_false(admission_waiting(&admission));
    admission_enter(&admission, 0, 200);
    assert_true(admission_room(&admission, 0));
    assert_int_equal(take_of_client(200, 10, SECOND), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_sources_are_served_in_turn, set_up),
        cmocka_unit_test_setup(test_a_source_keeps_its_order, set_up),
        cmocka_unit_test_setup(test_a_flood_is_held_to_its_budget, set_up),
        cmocka_unit_test_setup(test_spawns_have_a_budget_for_one_and_for_all, set_up),
        cmocka_unit_test_setup(test_operators_go_first_and_have_reserved_slots, set_up),
        cmocka_unit_test_setup(test_a_strained_world_gets_few_costly_commands, set_up),
        cmocka_unit_test_setup(test_a_freed_source_is_empty, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
