/* Histograms of times, which the slots of the roles hold. */
#ifndef JOLON_IPC_SEGMENT_HISTOGRAM_H
#define JOLON_IPC_SEGMENT_HISTOGRAM_H

#include <stdint.h>

/* A log-linear histogram of times: 16 buckets a factor of two, 64 ns to 18 min; error under 7 %. */
#define HISTOGRAM_BUCKETS 560u

struct histogram {
    uint64_t count;
    uint64_t max_ns;
    uint32_t bucket[HISTOGRAM_BUCKETS];
};

void histogram_add(struct histogram *histogram, uint64_t ns);
/* Returns the time below which this fraction (0..1) of the entries lies [ns], 0 when empty. */
uint64_t histogram_quantile(const struct histogram *histogram, double fraction);

/* Writes into since the entries of now that are not in before, two copies of one histogram that
 * another process fills. Its maximum is that of its highest bucket. */
void histogram_since(struct histogram *since, const struct histogram *now,
                     const struct histogram *before);

#endif
