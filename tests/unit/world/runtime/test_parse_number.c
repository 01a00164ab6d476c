/* Numbers of a text: what is one, ranges, and that a number printed is the number read. */
#include "world/runtime/parse_number.h"

#include "world/maths/random.h"

#include <float.h>
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

static void test_no_numbers(void **state)
{
    static const char *const whole[] = {
        "", " 1", "1 ", "+1", "-1", "1.0", "1e3", "0x1", "one", "1,0", "18446744073709551616"};
    static const char *const real[] = {"",    "1 ",    "1,5", "one",  "1e",
                                       "--1", "1e999", "nan", "0x10", "-0X1p3"};
    uint64_t number;
    double value;
    (void)state;
    for (size_t i = 0; i < sizeof whole / sizeof whole[0]; i++)
        if (parse_whole(whole[i], 0, UINT64_MAX, &number))
            fail_msg("\"%s\" is read as %" PRIu64, whole[i], number);
    for (size_t i = 0; i < sizeof real / sizeof real[0]; i++)
        if (parse_real(real[i], -DBL_MAX, DBL_MAX, &value))
            fail_msg("\"%s\" is read as %g", real[i], value);
}

static void test_ends_of_ranges(void **state)
{
    uint64_t number;
    double value;
    (void)state;
    assert_true(parse_whole("3", 3, 5, &number) && parse_whole("5", 3, 5, &number));
    assert_false(parse_whole("2", 3, 5, &number) || parse_whole("6", 3, 5, &number));
    assert_true(parse_whole("18446744073709551615", 0, UINT64_MAX, &number));
    assert_true(parse_real("-0.5", -0.5, 2.5, &value) && parse_real("2.5", -0.5, 2.5, &value));
    assert_false(parse_real("-0.51", -0.5, 2.5, &value) || parse_real("2.51", -0.5, 2.5, &value));
}

static void test_what_is_printed_is_read(void **state)
{
    const uint64_t seed = 20;
    char text[64];
    uint64_t number, random = seed;
    double value;
    (void)state;
    print_message("# SEED=%" PRIu64 "\n", seed);
    for (int i = 0; i < 10000; i++) {
        random = random_mix(random + 1);
        uint64_t wanted = random >> (i & 63);
        double real = (double)(int64_t)random / (1.0 + (double)(random & 0xfff));
        (void)snprintf(text, sizeof text, "%" PRIu64, wanted);
        if (!parse_whole(text, wanted, wanted, &number) || number != wanted)
            fail_msg("SEED=%" PRIu64 ": %s", seed, text);
        (void)snprintf(text, sizeof text, "%.17g", real);
        if (!parse_real(text, real, real, &value) || value != real)
            fail_msg("SEED=%" PRIu64 ": %s", seed, text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_numbers),
        cmocka_unit_test(test_ends_of_ranges),
        cmocka_unit_test(test_what_is_printed_is_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
