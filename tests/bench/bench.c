/* What all benchmarks use. */
#include "tests/bench/bench.h"

#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

double bench_quantile(double *values, uint32_t count, double fraction)
{
    qsort(values, count, sizeof *values, ascending);
    return count ? values[(uint32_t)(fraction * (double)(count - 1) + 0.5)] : 0.0;
}

const char *bench_mode_word(enum bench_mode mode)
{
    static const char *const word[] = {"scenario", "idle", "patrol", "war", "dense"};
    return word[mode];
}
