/* Draws frame times as bars. */
#include "clients/monitor/sparkline.h"

#include <string.h>

#define LEVELS 8

void sparkline_add(struct sparkline *sparkline, double value)
{
    sparkline->sample[sparkline->count++ % SPARKLINE_SAMPLES] = (float)value;
}

static size_t kept(const struct sparkline *sparkline, size_t wanted)
{
    size_t stored =
        sparkline->count < SPARKLINE_SAMPLES ? (size_t)sparkline->count : SPARKLINE_SAMPLES;
    return wanted < stored ? wanted : stored;
}

/* Sample n of the last `last` ones, the oldest first. */
static double sample(const struct sparkline *sparkline, size_t last, size_t n)
{
    return (double)sparkline->sample[(sparkline->count - last + n) % SPARKLINE_SAMPLES];
}

void sparkline_text(char text[SPARKLINE_TEXT_MAX], const struct sparkline *sparkline,
                    size_t columns, double full, bool utf8)
{
    static const char *const blocks[LEVELS] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
    static const char letters[LEVELS] = {'_', '.', ',', '-', ':', '=', '+', '#'};
    size_t last = kept(sparkline, columns), used = 0;
    for (size_t n = 0; n < last; n++) {
        double value = sample(sparkline, last, n);
        int level = full > 0.0 ? (int)(value / full * LEVELS) : 0;
        if (value > full) {
            text[used++] = '!';
        } else if (!utf8) {
            text[used++] = letters[level < LEVELS ? level : LEVELS - 1];
        } else {
            const char *block = blocks[level < LEVELS ? level : LEVELS - 1];
            size_t bytes = strlen(block);
            memcpy(text + used, block, bytes);
            used += bytes;
        }
    }
    text[used] = '\0';
}

double sparkline_max(const struct sparkline *sparkline, size_t samples)
{
    double max = 0.0;
    size_t last = kept(sparkline, samples);
    for (size_t n = 0; n < last; n++) {
        double value = sample(sparkline, last, n);
        max = value > max ? value : max;
    }
    return max;
}
