/* Time stamps: the worked case, the ends of the hour, and differences across them. */
#include "gateway/pdu/timestamp.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>

#include <cmocka.h>

#define UNIT_S (3600.0 / 2147483648.0)

static void test_the_worked_case(void **state)
{
    (void)state;
    assert_int_equal(timestamp_of(1234.5, false), 0x57c962fc);
    assert_int_equal(timestamp_of(1234.5, true), 0x57c962fd);
    assert_true(fabs(timestamp_seconds(0x57c962fd) - 1234.5) < UNIT_S);
    assert_true(timestamp_absolute(0x57c962fd) && !timestamp_absolute(0x57c962fc));
}

static void test_the_hour(void **state)
{
    (void)state;
    assert_int_equal(timestamp_of(0.0, false), 0);
    assert_int_equal(timestamp_of(0.75 * UNIT_S, false), 0);
    assert_int_equal(timestamp_of(3600.0, false), 0);
    assert_int_equal(timestamp_of(7200.0 + 1234.5, false), 0x57c962fc);
    assert_int_equal(timestamp_of(1234.5 - 3600.0, false), 0x57c962fc);
    assert_int_equal(timestamp_of(-1e-30, false), 0xfffffffe);
    assert_int_equal(timestamp_of(3600.0 - UNIT_S, true), 0xffffffff);
    assert_int_equal(timestamp_of(NAN, true), 1);
    assert_true(timestamp_seconds(0xffffffff) < 3600.0);
}

static void test_differences(void **state)
{
    (void)state;
    uint32_t late = timestamp_of(3599.0, true), early = timestamp_of(1.0, false);
    assert_true(fabs(timestamp_between(late, early) - 2.0) < 2 * UNIT_S);
    assert_true(fabs(timestamp_between(early, late) + 2.0) < 2 * UNIT_S);
    assert_true(timestamp_between(late, late) == 0.0);
    assert_true(timestamp_between(0, timestamp_of(1800.0, false)) == -1800.0);
    assert_true(fabs(timestamp_between(0, timestamp_of(1799.0, false)) - 1799.0) < UNIT_S);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_worked_case),
        cmocka_unit_test(test_the_hour),
        cmocka_unit_test(test_differences),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
