/* The sparkline: how long frames took, sample after sample, as a row of bars. Pure. */
#ifndef JOLON_MONITOR_SPARK_H
#define JOLON_MONITOR_SPARK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SPARK_SAMPLES  512u
#define SPARK_TEXT_MAX (3u * SPARK_SAMPLES + 1u)

struct spark {
    float sample[SPARK_SAMPLES]; /* a ring, [count % SPARK_SAMPLES] next */
    uint64_t count;
};

void spark_add(struct spark *spark, double value);

/* The last samples, at most columns of them, the newest at the right: from nothing to a full bar at
 * full; '!' for what is above it. In the eighths of a block of UTF-8, or plain letters. */
void spark_text(char text[SPARK_TEXT_MAX], const struct spark *spark, size_t columns, double full,
                bool utf8);

/* The greatest of the last samples, 0 of none. */
double spark_most(const struct spark *spark, size_t samples);

#endif
