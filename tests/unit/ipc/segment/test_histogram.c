/* Histograms of times against the sorted times themselves. */
#include "ipc/segment/histogram.h"

#include "tests/support/fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define TIMES 10000

static void test_empty_histogram_says_0(void **state)
{
    const struct histogram histogram = {0};
    (void)state;
    assert_int_equal(histogram_quantile(&histogram, 0.0), 0);
    assert_int_equal(histogram_quantile(&histogram, 0.99), 0);
    assert_int_equal(histogram_quantile(&histogram, 1.0), 0);
}

/* What came between two looks alone; a look that saw less than the one before it gives nothing. */
static void test_histogram_since(void **state)
{
    static struct histogram before, now, since;
    (void)state;
    histogram_add(&before, 1000);
    histogram_add(&before, 9000000);
    now = before;
    histogram_add(&now, 2000);
    histogram_add(&now, 2000);
    histogram_add(&now, 50000);
    histogram_since(&since, &now, &before);
    assert_int_equal(since.count, 3);
    assert_true(fabs((double)histogram_quantile(&since, 0.5) - 2000.0) < 140.0);
    assert_true(fabs((double)since.max_ns - 50000.0) < 3500.0);
    histogram_since(&since, &before, &now);
    assert_int_equal(since.count, 0);
    assert_int_equal(histogram_quantile(&since, 0.5), 0);
}

/* One entry: every quantile is that entry, to 7 % from 64 ns to 18 min. */
static void test_one_time_comes_back_within_7_percent(void **state)
{
    (void)state;
    for (double ns = 64.0; ns < 18.0 * 60.0 * 1e9; ns *= 1.003) {
        struct histogram histogram = {0};
        histogram_add(&histogram, (uint64_t)ns);
        histogram_add(&histogram, UINT64_MAX); /* so that the maximum does not cap the answer */
        uint64_t back = histogram_quantile(&histogram, 0.0);
        assert_true(fabs((double)back - ns) < 0.07 * ns);
    }
}

static void test_times_out_of_range_are_kept_in_the_end_buckets(void **state)
{
    struct histogram histogram = {0};
    (void)state;
    histogram_add(&histogram, 0);
    histogram_add(&histogram, 1);
    histogram_add(&histogram, 63);
    assert_int_equal(histogram.bucket[0], 3);
    assert_int_equal(histogram_quantile(&histogram, 1.0), 63); /* never above the maximum */
    histogram_add(&histogram, UINT64_MAX);
    histogram_add(&histogram, (uint64_t)1 << 41); /* the first that is past the last bucket */
    assert_int_equal(histogram.bucket[HISTOGRAM_BUCKETS - 1], 2);
    assert_int_equal(histogram.max_ns, UINT64_MAX);
    assert_int_equal(histogram.count, 5);
}

static int by_value(const void *a, const void *b)
{
    uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return p < q ? -1 : p > q;
}

static void test_quantiles_are_those_of_the_sorted_times(void **state)
{
    static uint64_t times[TIMES];
    struct histogram histogram = {0};
    uint64_t random = fixture_seed(1);
    (void)state;
    for (int i = 0; i < TIMES; i++) {
        times[i] = (uint64_t)exp(fixture_uniform(&random, 5.0, 25.0));
        histogram_add(&histogram, times[i]);
    }
    qsort(times, TIMES, sizeof times[0], by_value);
    for (int percent = 0; percent <= 100; percent++) {
        double right = (double)times[(uint64_t)(percent / 100.0 * (TIMES - 1))];
        double got = (double)histogram_quantile(&histogram, percent / 100.0);
        assert_true(fabs(got - right) < 0.07 * right);
    }
    assert_int_equal(histogram.count, TIMES);
    assert_int_equal(histogram.max_ns, times[TIMES - 1]);
}

static void test_quantiles_do_not_fall(void **state)
{
    struct histogram histogram = {0};
    uint64_t random = fixture_seed(2), last = 0;
    (void)state;
    for (int i = 0; i < 1000; i++)
        histogram_add(&histogram, fixture_random(&random) >> (fixture_random(&random) % 60));
    for (int i = 0; i <= 1000; i++) {
        uint64_t now = histogram_quantile(&histogram, i / 1000.0);
        assert_true(now >= last);
        last = now;
    }
    assert_true(last <= histogram.max_ns);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_empty_histogram_says_0),
        cmocka_unit_test(test_histogram_since),
        cmocka_unit_test(test_one_time_comes_back_within_7_percent),
        cmocka_unit_test(test_times_out_of_range_are_kept_in_the_end_buckets),
        cmocka_unit_test(test_quantiles_are_those_of_the_sorted_times),
        cmocka_unit_test(test_quantiles_do_not_fall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
