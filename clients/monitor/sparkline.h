/* The sparkline: how long frames took, sample after sample, as a row of bars. Pure. */
#ifndef JOLON_CLIENTS_MONITOR_SPARKLINE_H
#define JOLON_CLIENTS_MONITOR_SPARKLINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SPARKLINE_SAMPLES  512u
#define SPARKLINE_TEXT_MAX (3u * SPARKLINE_SAMPLES + 1u)

struct sparkline {
    float sample[SPARKLINE_SAMPLES]; /* a ring, [count % SPARKLINE_SAMPLES] next */
    uint64_t count;
};

void sparkline_add(struct sparkline *sparkline, double value);

/* The last samples, at most columns of them, the newest at the right: from nothing to a full bar at
 * full; '!' for what is above it. In the eighths of a block of UTF-8, or plain letters. */
void sparkline_text(char text[SPARKLINE_TEXT_MAX], const struct sparkline *sparkline,
                    size_t columns, double full, bool utf8);

/* The greatest of the last samples, 0 of none. */
double sparkline_max(const struct sparkline *sparkline, size_t samples);

#endif
