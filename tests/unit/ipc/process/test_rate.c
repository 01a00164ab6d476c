/* Rates: a burst at once, and then the pace. */
#include "ipc/process/rate.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SECOND 1000000000ull

static void test_a_rate_grants_a_burst_and_then_its_pace(void **state)
{
    struct rate rate = {0};
    uint64_t now_ns = 5 * SECOND;
    uint32_t granted = 0;
    (void)state;
    for (int i = 0; i < 100; i++)
        granted += rate_take(&rate, 10, 20, now_ns);
    assert_int_equal(granted, 20);
    for (uint64_t ms = 0; ms < 10000; ms++)
        granted += rate_take(&rate, 10, 20, now_ns + ms * (SECOND / 1000));
    assert_in_range(granted, 20 + 99, 20 + 101);
    granted = 0;
    for (int i = 0; i < 100; i++)
        granted += rate_take(&rate, 10, 20, now_ns + 3600 * SECOND);
    assert_int_equal(granted, 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_rate_grants_a_burst_and_then_its_pace),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
