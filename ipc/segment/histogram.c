/* Histograms of times. */
#include "ipc/segment/histogram.h"

#include "ipc/process/crash_point.h"

#define FIRST_POWER 6u /* 64 ns: everything below is in bucket 0 */

static uint32_t bucket_of(uint64_t ns)
{
    if (ns < (1u << FIRST_POWER))
        return 0;
    uint32_t power = 63u - (uint32_t)__builtin_clzll(ns);
    uint32_t index = (power - FIRST_POWER) * 16u + (uint32_t)(ns >> (power - 4) & 15u);
    return index < HISTOGRAM_BUCKETS ? index : HISTOGRAM_BUCKETS - 1;
}

/* Middle of a bucket. */
static uint64_t bucket_ns(uint32_t index)
{
    uint32_t power = index / 16u + FIRST_POWER;
    uint64_t step = (uint64_t)1 << (power - 4);
    return ((uint64_t)1 << power) + (index % 16u) * step + step / 2;
}

void histogram_add(struct histogram *histogram, uint64_t ns)
{
    CRASH_POINT("histogram's bucket");
    histogram->bucket[bucket_of(ns)]++;
    CRASH_POINT("histogram's count");
    histogram->count++;
    CRASH_POINT("histogram's most");
    if (ns > histogram->max_ns)
        histogram->max_ns = ns;
}

uint64_t histogram_quantile(const struct histogram *histogram, double fraction)
{
    uint64_t total = 0, below = 0;
    for (uint32_t i = 0; i < HISTOGRAM_BUCKETS; i++)
        total += histogram->bucket[i];
    if (total == 0)
        return 0;
    uint64_t wanted = (uint64_t)(fraction * (double)(total - 1)) + 1;
    for (uint32_t i = 0; i < HISTOGRAM_BUCKETS; i++) {
        below += histogram->bucket[i];
        if (below >= wanted)
            return bucket_ns(i) < histogram->max_ns ? bucket_ns(i) : histogram->max_ns;
    }
    return histogram->max_ns;
}

void histogram_since(struct histogram *since, const struct histogram *now,
                     const struct histogram *before)
{
    *since = (struct histogram){0};
    for (uint32_t i = 0; i < HISTOGRAM_BUCKETS; i++) {
        uint32_t count =
            now->bucket[i] > before->bucket[i] ? now->bucket[i] - before->bucket[i] : 0;
        since->bucket[i] = count;
        since->count += count;
        if (count > 0)
            since->max_ns = bucket_ns(i) < now->max_ns ? bucket_ns(i) : now->max_ns;
    }
}
