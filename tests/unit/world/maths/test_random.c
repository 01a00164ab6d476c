/* Random numbers: golden values, ranges, and that each argument alone makes other numbers. */
#include "world/maths/random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* Made by a second implementation, in Python. Runs are recorded with their seed: another generator
 * would make another history of each. */
static void test_golden_values(void **state)
{
    (void)state;
    assert_int_equal(random_u64(0, 0, 0, RANDOM_PLACE_X), 0xd78ee45a9637b812);
    assert_int_equal(random_u64(1991, 0, 0, RANDOM_HEADING), 0xaa022158aa25c908);
    assert_int_equal(random_u64(1991, 60, 499, RANDOM_COURAGE), 0x3012745d0a2c3c31);
    assert_int_equal(random_u64(UINT64_MAX, UINT64_MAX, UINT64_MAX, RANDOM_SQUARE_SIZE),
                     0xa36763e693ba77e2);
}

static void test_same_arguments_same_number_in_any_order(void **state)
{
    uint64_t forwards[64];
    (void)state;
    for (uint64_t i = 0; i < 64; i++)
        forwards[i] = random_u64(7, i, i * i, RANDOM_GOAL_X);
    for (uint64_t i = 64; i-- > 0;)
        assert_int_equal(random_u64(7, i, i * i, RANDOM_GOAL_X), forwards[i]);
}

static void test_unit_is_at_least_0_and_below_1(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 100000; i++) {
        double unit = random_unit(1, i, 3, RANDOM_NOISE);
        assert_true(unit >= 0.0 && unit < 1.0);
    }
}

static void test_between_stays_between(void **state)
{
    double least = 1e9, most = -1e9;
    (void)state;
    for (uint64_t i = 0; i < 100000; i++) {
        double value = random_between(1, i, 3, RANDOM_GOAL_Z, -20.0, 80.0);
        assert_true(value >= -20.0 && value < 80.0);
        least = value < least ? value : least;
        most = value > most ? value : most;
    }
    assert_true(least < -19.9 && most > 79.9);
    assert_true(random_between(1, 2, 3, RANDOM_GOAL_Z, 5.0, 5.0) == 5.0);
}

/* One bit more or less in any argument changes about half of the number's bits. */
static void test_every_argument_bit_counts(void **state)
{
    (void)state;
    for (int argument = 0; argument < 3; argument++) {
        for (int bit = 0; bit < 64; bit++) {
            uint64_t changed = 0;
            for (uint64_t i = 0; i < 256; i++) {
                uint64_t from[3] = {i * 77, i * 13, i}, to[3] = {i * 77, i * 13, i};
                to[argument] ^= (uint64_t)1 << bit;
                uint64_t difference = random_u64(from[0], from[1], from[2], RANDOM_OBJECT_X) ^
                                      random_u64(to[0], to[1], to[2], RANDOM_OBJECT_X);
                changed += (uint64_t)__builtin_popcountll(difference);
            }
            assert_in_range(changed, 256 * 30, 256 * 34); /* 8 standard errors */
        }
    }
}

static void test_every_purpose_draws_its_own(void **state)
{
    (void)state;
    for (int a = RANDOM_PLACE_X; a <= RANDOM_SQUARE_SIZE; a++) {
        for (int b = a + 1; b <= RANDOM_SQUARE_SIZE; b++)
            assert_int_not_equal(random_u64(1, 2, 3, (enum random_purpose)a),
                                 random_u64(1, 2, 3, (enum random_purpose)b));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_golden_values),
        cmocka_unit_test(test_same_arguments_same_number_in_any_order),
        cmocka_unit_test(test_unit_is_at_least_0_and_below_1),
        cmocka_unit_test(test_between_stays_between),
        cmocka_unit_test(test_every_argument_bit_counts),
        cmocka_unit_test(test_every_purpose_draws_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
