/* The levels of quality, and when they change. */
#include "renderer/quality_control.h"

#include <math.h>
#include <stdbool.h>

const struct quality_control_level quality_control_levels[QUALITY_CONTROL_LEVELS] = {
    {1.0, 4}, {0.7, 4}, {0.5, 4}, {0.35, 4}, {0.35, 3}, {0.35, 2},
};

void quality_control_init(struct quality_control *quality, double fps)
{
    *quality = (struct quality_control){.interval_s = fps > 0.0 ? 1.0 / fps : 0.0,
                                        .raise_delay_s = QUALITY_CONTROL_RAISE_DELAY_S,
                                        .raised_s = -INFINITY};
}

double quality_control_median_s(const struct quality_control *quality)
{
    double sorted[QUALITY_CONTROL_PICTURES];
    if (quality->count < QUALITY_CONTROL_PICTURES)
        return 0.0;
    for (uint32_t i = 0; i < QUALITY_CONTROL_PICTURES; i++) {
        uint32_t place = i;
        for (; place > 0 && sorted[place - 1] > quality->took_s[i]; place--)
            sorted[place] = sorted[place - 1];
        sorted[place] = quality->took_s[i];
    }
    return sorted[QUALITY_CONTROL_PICTURES / 2];
}

static int change(struct quality_control *quality, int by, double now_s)
{
    quality->judged_s = quality_control_median_s(quality);
    quality->level = by < 0 ? quality->level + 1 : quality->level - 1;
    quality->count = 0;
    quality->idle_since_s = now_s;
    if (by > 0) {
        quality->raised_s = now_s;
        return by;
    }
    /* A fall soon after a raise means that the raise was too early; a later one has another cause.
     */
    bool too_early = now_s - quality->raised_s < QUALITY_CONTROL_TRIAL_S;
    quality->raise_delay_s =
        too_early ? fmin(2.0 * quality->raise_delay_s, QUALITY_CONTROL_RAISE_DELAY_MAX_S)
                  : QUALITY_CONTROL_RAISE_DELAY_S;
    return by;
}

int quality_control_note(struct quality_control *quality, double took_s, double now_s)
{
    if (quality->interval_s <= 0.0)
        return 0;
    quality->took_s[quality->count % QUALITY_CONTROL_PICTURES] = took_s;
    quality->count++;
    double median_s = quality_control_median_s(quality);
    if (quality->count < QUALITY_CONTROL_PICTURES ||
        median_s > QUALITY_CONTROL_IDLE * quality->interval_s)
        quality->idle_since_s = now_s;
    if (median_s > QUALITY_CONTROL_BUSY * quality->interval_s &&
        quality->level + 1 < QUALITY_CONTROL_LEVELS)
        return change(quality, -1, now_s);
    if (quality->level > 0 && now_s - quality->idle_since_s >= quality->raise_delay_s)
        return change(quality, 1, now_s);
    return 0;
}
