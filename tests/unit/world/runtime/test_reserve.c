/* Address space that becomes memory page by page: world/runtime/reserve.h. */
#include "world/runtime/reserve.h"

#include "tests/support/child.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/resource.h>

#include <cmocka.h>

#define MEGABYTE (UINT64_C(1) << 20)

/* Memory that this process has [bytes]. */
static uint64_t resident(void)
{
    unsigned long long size = 0, pages = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%llu %llu", &size, &pages), 2);
    fclose(file);
    return pages * 4096;
}

static void test_far_more_than_the_machine_has_costs_only_written_pages(void **state)
{
    uint64_t before = resident(), count = UINT64_C(1) << 38;
    (void)state;
    unsigned char *memory = reserve_take(count, 1);
    assert_non_null(memory);
    assert_int_equal((uintptr_t)memory % RESERVE_ALIGN, 0);
    for (uint64_t at = 0; at < count; at += count / 64) {
        assert_int_equal(memory[at], 0);
        memory[at] = 7;
    }
    memory[count - 1] = 9;
    assert_true(resident() < before + 200 * MEGABYTE);
    reserve_free(memory);
    assert_true(resident() < before + MEGABYTE);
}

static void test_a_few_items_cost_a_page(void **state)
{
    uint64_t before = resident();
    int *memory[100];
    (void)state;
    for (int i = 0; i < 100; i++) {
        memory[i] = reserve_take(MEGABYTE, sizeof(int));
        assert_non_null(memory[i]);
        memory[i][3] = i;
    }
    assert_true(resident() < before + 4 * MEGABYTE);
    for (int i = 0; i < 100; i++) {
        assert_int_equal(memory[i][3], i);
        reserve_free(memory[i]);
    }
    reserve_free(NULL);
}

static void test_a_larger_array_keeps_its_items(void **state)
{
    uint64_t before = resident();
    uint32_t *array = reserve_take(1000, sizeof *array);
    (void)state;
    assert_non_null(array);
    for (uint32_t i = 0; i < 1000; i++)
        array[i] = i + 1;
    for (uint64_t count = 2000; count <= UINT64_C(1) << 34; count *= 64) {
        array = reserve_grow(array, 900, count, sizeof *array);
        assert_int_equal((uintptr_t)array % RESERVE_ALIGN, 0);
        for (uint32_t i = 0; i < 900; i++)
            assert_int_equal(array[i], i + 1);
        assert_int_equal(array[900], 0);
        array[count - 1] = 9;
    }
    assert_true(resident() < before + 4 * MEGABYTE);
    reserve_free(array);
}

static void test_what_no_process_can_have_is_refused(void **state)
{
    (void)state;
    errno = 0;
    assert_null(reserve_take(UINT64_MAX, 8));
    assert_int_equal(errno, ENOMEM);
    assert_null(reserve_take(UINT64_C(1) << 50, 8));
    assert_int_equal(errno, ENOMEM);
    assert_null(reserve_take(5, 0));
}

static int reserve_within_a_limit(void *context)
{
    const struct rlimit limit = {1 << 30, 1 << 30};
    (void)context;
    if (setrlimit(RLIMIT_AS, &limit) != 0)
        return 2;
    void *memory = reserve_take(UINT64_C(1) << 31, 1);
    return memory == NULL && errno == ENOMEM ? 0 : 1;
}

static void test_a_limit_on_address_space_refuses_at_once(void **state)
{
    (void)state;
    assert_int_equal(child_run(reserve_within_a_limit, NULL), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_far_more_than_the_machine_has_costs_only_written_pages),
        cmocka_unit_test(test_a_few_items_cost_a_page),
        cmocka_unit_test(test_a_larger_array_keeps_its_items),
        cmocka_unit_test(test_what_no_process_can_have_is_refused),
        cmocka_unit_test(test_a_limit_on_address_space_refuses_at_once),
    };
    return cmocka_run_group_tests_name("reserve", tests, NULL, NULL);
}
