/* A sparkline: frame times as a row of bars. Pure. */
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

/* Writes at most `columns` of the last samples, the newest at the right. The value `full` is a full
 * bar; a greater one is '!'. utf8: uses the eighths of a block instead of ASCII characters. */
void sparkline_text(char text[SPARKLINE_TEXT_MAX], const struct sparkline *sparkline,
                    size_t columns, double full, bool utf8);

/* Returns the greatest of the last samples, 0 if there are none. */
double sparkline_max(const struct sparkline *sparkline, size_t samples);

#endif
