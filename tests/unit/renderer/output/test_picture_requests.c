/* The table of requested pictures: rows are shared, bounded and evicted. */
#include "renderer/output/picture_requests.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SECOND 1000000000ull

static struct picture_requests_table table;

static int set_up(void **state)
{
    (void)state;
    table = (struct picture_requests_table){.generations = 0};
    return 0;
}

static struct picture_requests_key key_of(uint32_t vehicle)
{
    return (struct picture_requests_key){
        .view = VIEW_CHASE, .vehicle = vehicle, .width = 640, .height = 360, .bar = true};
}

static uint32_t ask(uint32_t vehicle, uint64_t now_ns)
{
    const struct picture_requests_key key = key_of(vehicle);
    return picture_requests_ask(&table, &key, now_ns);
}

static void test_the_same_picture_is_one_row(void **state)
{
    struct picture_requests_key key = key_of(1), others[] = {key, key, key, key, key};
    (void)state;
    uint32_t row = picture_requests_ask(&table, &key, SECOND);
    assert_int_equal(picture_requests_ask(&table, &key, SECOND + 1), row);
    assert_int_equal(table.row[row].requested_ns, SECOND + 1);
    others[0].view = VIEW_INSIDE;
    others[1].vehicle = 2;
    others[2].width++;
    others[3].height++;
    others[4].bar = false;
    for (int i = 0; i < 5; i++)
        assert_int_not_equal(picture_requests_ask(&table, &others[i], SECOND), row);
    assert_int_equal(table.generations, 6);
}

/* Requests vehicles 0 to PICTURE_REQUESTS_MAX - 1 twice each. */
static void fill_with_watched(void)
{
    for (uint32_t i = 0; i < 2 * PICTURE_REQUESTS_MAX; i++)
        assert_int_not_equal(ask(i % PICTURE_REQUESTS_MAX, SECOND + i), PICTURE_REQUESTS_NONE);
}

static void test_a_full_table_says_so_until_a_row_is_given_up(void **state)
{
    (void)state;
    fill_with_watched();
    assert_int_equal(ask(99, 2 * SECOND), PICTURE_REQUESTS_NONE);
    assert_int_not_equal(ask(3, 2 * SECOND), PICTURE_REQUESTS_NONE);
    /* The first is given up just after PICTURE_REQUESTS_KEEP_NS, and the one asked for again is
     * not. */
    assert_int_equal(ask(99, SECOND + PICTURE_REQUESTS_MAX + PICTURE_REQUESTS_KEEP_NS - 1),
                     PICTURE_REQUESTS_NONE);
    assert_int_equal(ask(99, SECOND + PICTURE_REQUESTS_MAX + PICTURE_REQUESTS_KEEP_NS), 0);
    assert_int_equal(table.row[0].key.vehicle, 99);
    assert_true(picture_requests_lives(&table.row[3], SECOND + PICTURE_REQUESTS_KEEP_NS +
                                                          2 * PICTURE_REQUESTS_MAX));
}

static void test_who_looks_once_keeps_nobody_out(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX; i++)
        ask(i, SECOND + i);
    table.row[0].unanswered = 1;
    ask(1, 2 * SECOND); /* now it is watched */
    /* Rows with a waiting client and watched rows stay; of the others the oldest is evicted. */
    for (uint32_t i = 2; i < PICTURE_REQUESTS_MAX; i++)
        assert_int_equal(ask(100 + i, 2 * SECOND + i), i);
    assert_int_equal(table.row[0].key.vehicle, 0);
    assert_int_equal(table.row[1].key.vehicle, 1);
    assert_int_equal(ask(200, 2 * SECOND + PICTURE_REQUESTS_MAX), 2);
    /* A row without a recent request is evicted first. */
    table.row[0].unanswered = 0;
    assert_int_equal(ask(201, 2 * SECOND + PICTURE_REQUESTS_KEEP_NS - 1), 0);
}

static void test_who_waits_keeps_the_row(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX; i++)
        table.row[ask(i, SECOND)].unanswered = 1;
    assert_int_equal(ask(99, 100 * SECOND), PICTURE_REQUESTS_NONE);
    table.row[5].unanswered = 0;
    assert_int_equal(ask(99, 100 * SECOND), 5);
}

static void test_a_row_that_comes_back_is_another(void **state)
{
    (void)state;
    uint32_t row = ask(1, SECOND);
    uint64_t generation = table.row[row].generation;
    table.row[row].gone = true;
    assert_int_equal(ask(1, 10 * SECOND), row);
    assert_int_not_equal(table.row[row].generation, generation);
    assert_false(table.row[row].gone);
}

static void test_a_row_is_forgotten_when_nobody_waits(void **state)
{
    (void)state;
    uint32_t row = ask(1, SECOND);
    table.row[row].unanswered = 1;
    picture_requests_forget(&table.row[row]);
    assert_true(picture_requests_lives(&table.row[row], SECOND));
    table.row[row].unanswered = 0;
    picture_requests_forget(&table.row[row]);
    assert_false(picture_requests_lives(&table.row[row], SECOND));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_the_same_picture_is_one_row, set_up),
        cmocka_unit_test_setup(test_a_full_table_says_so_until_a_row_is_given_up, set_up),
        cmocka_unit_test_setup(test_who_looks_once_keeps_nobody_out, set_up),
        cmocka_unit_test_setup(test_who_waits_keeps_the_row, set_up),
        cmocka_unit_test_setup(test_a_row_that_comes_back_is_another, set_up),
        cmocka_unit_test_setup(test_a_row_is_forgotten_when_nobody_waits, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
