/* Random numbers are uniform, and those of different purposes, frames and entities independent:
 * chi-square tests whose bounds a good generator passes with all but 1 in 10^6 seeds. */
#include "world/maths/random.h"

#include "tests/support/fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define DRAWS   200000
#define BUCKETS 256
#define SIDE    16 /* of the table of pairs: SIDE * SIDE buckets */

static uint64_t seed;

/* Chi-square with BUCKETS - 1 = 255 degrees of freedom is near normal: mean 255, deviation 22.6. */
static void check_uniform(const uint32_t count[BUCKETS])
{
    const double expected = (double)DRAWS / BUCKETS;
    double sum = 0.0;
    for (int i = 0; i < BUCKETS; i++)
        sum += ((double)count[i] - expected) * ((double)count[i] - expected) / expected;
    if (fabs(sum - 255.0) > 5.5 * 22.6)
        fail_msg("chi-square %.1f of 255 degrees of freedom", sum);
}

static int bucket(double unit, int buckets)
{
    return (int)(unit * buckets);
}

static void test_uniform_over_entities_frames_and_seeds(void **state)
{
    (void)state;
    for (int what = 0; what < 3; what++) {
        uint32_t count[BUCKETS] = {0};
        for (uint64_t i = 0; i < DRAWS; i++)
            count[bucket(random_unit(what == 2 ? seed + i : seed, what == 1 ? i : 5,
                                     what == 0 ? i : 9, RANDOM_HEADING),
                         BUCKETS)]++;
        check_uniform(count);
    }
}

static void test_low_bits_are_uniform(void **state)
{
    uint32_t count[BUCKETS] = {0};
    (void)state;
    for (uint64_t i = 0; i < DRAWS; i++)
        count[random_u64(seed, 1, i, RANDOM_FOREST) & (BUCKETS - 1)]++;
    check_uniform(count);
}

static void test_purposes_are_independent(void **state)
{
    (void)state;
    for (int a = RANDOM_PLACE_X; a <= RANDOM_SQUARE_SIZE; a++) {
        int b = a == RANDOM_SQUARE_SIZE ? RANDOM_PLACE_X : a + 1;
        uint32_t count[SIDE * SIDE] = {0};
        for (uint64_t i = 0; i < DRAWS; i++)
            count[bucket(random_unit(seed, 3, i, (enum random_purpose)a), SIDE) * SIDE +
                  bucket(random_unit(seed, 3, i, (enum random_purpose)b), SIDE)]++;
        check_uniform(count);
    }
}

static void test_neighbours_are_independent(void **state)
{
    uint32_t frames[SIDE * SIDE] = {0}, entities[SIDE * SIDE] = {0}, crossed[SIDE * SIDE] = {0};
    (void)state;
    for (uint64_t i = 0; i < DRAWS; i++) {
        int here = bucket(random_unit(seed, i, i & 7, RANDOM_NOISE), SIDE) * SIDE;
        frames[here + bucket(random_unit(seed, i + 1, i & 7, RANDOM_NOISE), SIDE)]++;
        entities[here + bucket(random_unit(seed, i, (i & 7) + 1, RANDOM_NOISE), SIDE)]++;
        /* (frame, entity) against (entity, frame): swapping them must not draw the same */
        crossed[here + bucket(random_unit(seed, (i & 7) + DRAWS, i, RANDOM_NOISE), SIDE)]++;
    }
    check_uniform(frames);
    check_uniform(entities);
    check_uniform(crossed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_uniform_over_entities_frames_and_seeds),
        cmocka_unit_test(test_low_bits_are_uniform),
        cmocka_unit_test(test_purposes_are_independent),
        cmocka_unit_test(test_neighbours_are_independent),
    };
    seed = fixture_seed(1991);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
