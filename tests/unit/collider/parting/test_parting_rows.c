/* The list of the rows that part: each once, and their pairs in one order. */
#include "collider/parting/parting_rows.h"
#include "tests/support/fixture.h"
#include "world/runtime/reserve.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static struct parting_rows rows;

static void test_a_row_is_listed_once(void **state)
{
    (void)state;
    assert_true(parting_rows_add(&rows, 7));
    assert_true(parting_rows_add(&rows, 3));
    assert_false(parting_rows_add(&rows, 7));
    assert_int_equal(rows.count, 2);
    assert_int_equal(rows.row[rows.place[7] - 1], 7);
    assert_int_equal(rows.row[rows.place[3] - 1], 3);
    assert_int_equal(rows.place[5], 0);
    parting_rows_forget(&rows);
    assert_int_equal(rows.count, 0);
    assert_int_equal(rows.place[7], 0);
    assert_true(parting_rows_add(&rows, 7));
    parting_rows_forget(&rows);
}

static void test_pairs_are_sorted_and_have_room(void **state)
{
    const uint32_t count = (uint32_t)rows.pair_capacity + 5;
    uint32_t *of_pairs = reserve_take(rows.pair_capacity, sizeof *of_pairs);
    (void)state;
    for (uint32_t i = 0; i < count; i++)
        pair_list_add(&rows.list, count - i, count + 1);
    of_pairs = parting_rows_sort(&rows, of_pairs, sizeof *of_pairs);
    assert_true(rows.pair_capacity >= count);
    of_pairs[count - 1] = 1;
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(rows.list.pair[i].a, i + 1);
    parting_rows_forget(&rows);
    assert_int_equal(rows.list.count, 0);
    reserve_free(of_pairs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_row_is_listed_once),
        cmocka_unit_test(test_pairs_are_sorted_and_have_room),
    };
    fixture_open(&f, "world = { capacity = 64; };");
    if (parting_rows_init(&rows, &f.view.world) != 0)
        return 1;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    parting_rows_free(&rows);
    fixture_close(&f);
    return failed;
}
