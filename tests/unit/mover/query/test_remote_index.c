/* The index of remote rows finds what a search of all rows finds, whatever comes and goes. */
#include "mover/query/remote_index.h"

#include "world/entity/entity.h"
#include "world/entity/remote.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define ROWS       96u
#define IDENTITIES 40u

static struct entity row_of[ROWS];
static struct entities rows = {ROWS, row_of};
static struct remote_index remotes;

static int open_index(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < ROWS; i++) {
        row_of[i].behaviour = BEHAVIOUR_IDLE;
        row_of[i].driver = 0;
    }
    return remote_index_init(&remotes, ROWS, IDENTITIES);
}

static int close_index(void **state)
{
    (void)state;
    remote_index_free(&remotes);
    return 0;
}

static uint32_t search(uint64_t remote, uint32_t *count)
{
    uint32_t found = SLOT_NONE;
    *count = 0;
    for (uint32_t row = 0; row < ROWS; row++) {
        if (!remote_is(&rows, row))
            continue;
        ++*count;
        if (row_of[row].driver == remote && found == SLOT_NONE)
            found = row;
    }
    return found;
}

static void compare(void)
{
    for (uint64_t remote = 1; remote <= IDENTITIES; remote++) {
        uint32_t count, expected = search(remote, &count);
        assert_int_equal(remote_index_find(&remotes, &rows, ROWS, remote), expected);
        assert_int_equal(remotes.count, count);
    }
}

static void change(uint32_t row, uint8_t into, uint64_t remote)
{
    if (remote_is(&rows, row))
        remote_index_remove(&remotes, row, row_of[row].driver);
    row_of[row].behaviour = into;
    row_of[row].driver = remote;
    if (remote_is(&rows, row))
        remote_index_add(&remotes, row, remote);
}

static void test_it_finds_what_a_search_finds(void **state)
{
    (void)state;
    srand(7);
    for (int n = 0; n < 3000; n++) {
        uint32_t row = (uint32_t)rand() % ROWS, count;
        uint64_t remote = 1 + (uint64_t)rand() % IDENTITIES;
        const uint8_t into[] = {BEHAVIOUR_REMOTE, BEHAVIOUR_FLIGHT, BEHAVIOUR_IDLE};
        if (search(remote, &count) == SLOT_NONE)
            change(row, into[rand() % 3], remote);
        else
            change(row, BEHAVIOUR_IDLE, 0);
        if (rand() % 10 == 0)
            remote_index_forget(&remotes);
        compare();
    }
}

static void test_others_change_rows_before_it_is_made(void **state)
{
    (void)state;
    compare();
    remote_index_forget(&remotes);
    row_of[5].behaviour = BEHAVIOUR_REMOTE;
    row_of[5].driver = 3;
    remote_index_add(&remotes, 5, 3); /* it is not made, and counts the row once */
    compare();
    assert_int_equal(remote_index_find(&remotes, &rows, ROWS, 3), 5);
}

static void test_a_world_without_room_has_none(void **state)
{
    struct remote_index none;
    (void)state;
    assert_int_equal(remote_index_init(&none, ROWS, 0), 0);
    assert_int_equal(remote_index_find(&none, &rows, ROWS, 1), SLOT_NONE);
    assert_int_equal(none.count, 0);
    remote_index_touch(&none);
    remote_index_free(&none);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_it_finds_what_a_search_finds, open_index, close_index),
        cmocka_unit_test_setup_teardown(test_others_change_rows_before_it_is_made, open_index,
                                        close_index),
        cmocka_unit_test_setup_teardown(test_a_world_without_room_has_none, open_index,
                                        close_index),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
