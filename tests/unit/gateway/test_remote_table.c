/* The table of remote entities against a list: random additions, removals and look-ups. */
#include "gateway/remote_table.h"

#include "tests/support/remotes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define CAPACITY 50u
#define IDS      80u

static void test_random_operations(void **state)
{
    struct remote_table table;
    bool here[IDS] = {false};
    uint32_t count = 0;
    uint64_t random = fixture_seed(20261128);
    (void)state;
    assert_int_equal(remote_table_open(&table, CAPACITY), 0);
    for (int i = 0; i < 20000; i++) {
        uint32_t n = (uint32_t)(fixture_random(&random) % IDS);
        uint64_t remote = remote_id(7, 2, (uint16_t)(n + 1));
        struct remote_entry *entry = remote_table_find(&table, remote);
        assert_int_equal(entry != NULL, here[n]);
        if (entry) {
            assert_true(entry->remote == remote && entry->heard_ns == n);
            remote_table_remove(&table, entry);
            here[n] = false;
            count--;
        } else {
            entry = remote_table_add(&table, remote, n);
            assert_int_equal(entry != NULL, count < CAPACITY);
            here[n] = entry != NULL;
            count += here[n];
        }
        assert_int_equal(table.count, count);
        assert_true(table.used <= CAPACITY);
    }
    remote_table_close(&table);
}

static void test_no_room_at_all(void **state)
{
    struct remote_table table;
    (void)state;
    assert_int_equal(remote_table_open(&table, 0), 0);
    assert_null(remote_table_find(&table, 5));
    assert_null(remote_table_add(&table, 5, 1));
    remote_table_close(&table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_operations),
        cmocka_unit_test(test_no_room_at_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
