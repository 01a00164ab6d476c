/* Hashes of columns: sums that who changes a few words keeps right. */
#include "world/column_hash.h"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define WORDS 1024

static uint64_t words[WORDS];

static int fill(void **state)
{
    uint64_t seed = fixture_seed(3);
    (void)state;
    for (int n = 0; n < WORDS; n++)
        words[n] = fixture_random(&seed);
    return 0;
}

/* The hash is part of what two builds must agree on: with any vectors it is that of this loop. */
static void test_many_words_at_a_time_have_the_sum_of_all(void **state)
{
    uint64_t sum = COLUMN_HASH_BLANK;
    (void)state;
    for (uint64_t n = 0; n < WORDS; n++) {
        assert_true(column_hash(words, n * sizeof *words) == sum);
        sum += column_hash_word(words[n], column_hash_key(n));
    }
    assert_true(column_hash_word(1, column_hash_key(0)) == UINT64_C(0xcb2e1a59be1bc578));
}

static void test_bytes_at_the_end_count_as_a_word_that_ends_in_zeros(void **state)
{
    unsigned char *bytes = (unsigned char *)words;
    (void)state;
    for (size_t n = 1; n < sizeof *words; n++) {
        uint64_t part = column_hash(words, 80 + n);
        for (size_t k = n; k < sizeof *words; k++)
            bytes[80 + k] = 0;
        assert_true(column_hash(words, 88) == part);
        fill(state);
    }
}

static void test_zeros_count_nothing(void **state)
{
    static const uint64_t zeros[WORDS];
    (void)state;
    assert_true(column_hash(zeros, sizeof zeros) == COLUMN_HASH_BLANK);
    assert_true(column_hash(zeros, 3) == COLUMN_HASH_BLANK);
    words[WORDS - 1] = 0;
    assert_true(column_hash(words, sizeof words) == column_hash(words, sizeof words - 8));
}

/* Patterns in which sums of products of words and even keys would be the same. */
static void test_patterns_of_equal_values_do_not_cancel(void **state)
{
    uint64_t one[WORDS] = {0}, other[WORDS] = {0};
    (void)state;
    one[0] = one[3] = other[1] = other[2] = 7;
    assert_true(column_hash(one, sizeof one) != column_hash(other, sizeof other));
    for (int n = 0; n < WORDS; n++) { /* numbers without low bits, one up and one down */
        one[n] = UINT64_C(0x4010000000000000) + ((uint64_t)(n % 5) << 52);
        other[n] = one[n] + ((uint64_t)(n % 2 == 0) << 52) - ((uint64_t)(n % 2) << 52);
    }
    assert_true(column_hash(one, sizeof one) != column_hash(other, sizeof other));
    assert_true((uint32_t)column_hash(one, sizeof one) !=
                (uint32_t)column_hash(other, sizeof other));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_many_words_at_a_time_have_the_sum_of_all, fill),
        cmocka_unit_test_setup(test_bytes_at_the_end_count_as_a_word_that_ends_in_zeros, fill),
        cmocka_unit_test_setup(test_zeros_count_nothing, fill),
        cmocka_unit_test(test_patterns_of_equal_values_do_not_cancel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
