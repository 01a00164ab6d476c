/* Hashes of words: sums that who changes a few words keeps right. */
#include "world/word_hash.h"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

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
    uint64_t sum = WORD_HASH_BLANK;
    (void)state;
    for (uint64_t n = 0; n < WORDS; n++) {
        assert_true(word_hash(words, n) == sum);
        sum += word_hash_one(words[n], word_hash_key(n));
    }
    assert_true(word_hash_one(1, word_hash_key(0)) == UINT64_C(0xcb2e1a59be1bc578));
}

static void test_a_change_of_some_words_is_added(void **state)
{
    uint64_t before[9], hash = word_hash(words, WORDS);
    (void)state;
    memcpy(before, &words[100], sizeof before);
    words[100] = 0;
    words[104]++;
    assert_true(word_hash(words, WORDS) == hash + word_hash_change(&words[100], before, 9, 100));
    assert_true(word_hash_change(before, before, 9, 7) == 0);
}

static void test_zeros_count_nothing(void **state)
{
    static const uint64_t zeros[WORDS];
    (void)state;
    assert_true(word_hash(zeros, WORDS) == WORD_HASH_BLANK);
    words[WORDS - 1] = 0;
    assert_true(word_hash(words, WORDS) == word_hash(words, WORDS - 1));
}

/* Patterns in which sums of products of words and even keys would be the same. */
static void test_patterns_of_equal_values_do_not_cancel(void **state)
{
    uint64_t one[WORDS] = {0}, other[WORDS] = {0};
    (void)state;
    one[0] = one[3] = other[1] = other[2] = 7;
    assert_true(word_hash(one, WORDS) != word_hash(other, WORDS));
    for (int n = 0; n < WORDS; n++) { /* numbers without low bits, one up and one down */
        one[n] = UINT64_C(0x4010000000000000) + ((uint64_t)(n % 5) << 52);
        other[n] = one[n] + ((uint64_t)(n % 2 == 0) << 52) - ((uint64_t)(n % 2) << 52);
    }
    assert_true(word_hash(one, WORDS) != word_hash(other, WORDS));
    assert_true((uint32_t)word_hash(one, WORDS) != (uint32_t)word_hash(other, WORDS));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_many_words_at_a_time_have_the_sum_of_all, fill),
        cmocka_unit_test_setup(test_a_change_of_some_words_is_added, fill),
        cmocka_unit_test_setup(test_zeros_count_nothing, fill),
        cmocka_unit_test(test_patterns_of_equal_values_do_not_cancel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
