/* Levels, and when to change them. */
#include "renderer/quality_control.h"

#include <math.h>
#include <stdbool.h>

const struct quality_control_level quality_control_levels[QUALITY_CONTROL_LEVELS] = {
    {1.0, 4}, {0.7, 4}, {0.5, 4}, {0.35, 4}, {0.35, 3}, {0.35, 2},
};

void quality_control_init(struct quality_control *governor, double fps)
{
    *governor = (struct quality_control){.interval_s = fps > 0.0 ? 1.0 / fps : 0.0,
                                         .patience_s = QUALITY_CONTROL_PATIENCE_S,
                                         .raised_s = -INFINITY};
}

double quality_control_median_s(const struct quality_control *governor)
{
    double sorted[QUALITY_CONTROL_PICTURES];
    if (governor->count < QUALITY_CONTROL_PICTURES)
        return 0.0;
    for (uint32_t i = 0; i < QUALITY_CONTROL_PICTURES; i++) {
        uint32_t place = i;
        for (; place > 0 && sorted[place - 1] > governor->took_s[i]; place--)
            sorted[place] = sorted[place - 1];
        sorted[place] = governor->took_s[i];
    }
    return sorted[QUALITY_CONTROL_PICTURES / 2];
}

static int change(struct quality_control *governor, int by, double now_s)
{
    governor->judged_s = quality_control_median_s(governor);
    governor->level = by < 0 ? governor->level + 1 : governor->level - 1;
    governor->count = 0;
    governor->idle_since_s = now_s;
    if (by > 0) {
        governor->raised_s = now_s;
        return by;
    }
    /* Twice the patience when the rise was too much; else it is a new load, and as at first. */
    bool too_much = now_s - governor->raised_s < QUALITY_CONTROL_TRIAL_S;
    governor->patience_s = too_much ? fmin(2.0 * governor->patience_s, QUALITY_CONTROL_LONGEST_S)
                                    : QUALITY_CONTROL_PATIENCE_S;
    return by;
}

int quality_control_note(struct quality_control *governor, double took_s, double now_s)
{
    if (governor->interval_s <= 0.0)
        return 0;
    governor->took_s[governor->count % QUALITY_CONTROL_PICTURES] = took_s;
    governor->count++;
    double median_s = quality_control_median_s(governor);
    if (governor->count < QUALITY_CONTROL_PICTURES ||
        median_s > QUALITY_CONTROL_IDLE * governor->interval_s)
        governor->idle_since_s = now_s;
    if (median_s > QUALITY_CONTROL_BUSY * governor->interval_s &&
        governor->level + 1 < QUALITY_CONTROL_LEVELS)
        return change(governor, -1, now_s);
    if (governor->level > 0 && now_s - governor->idle_since_s >= governor->patience_s)
        return change(governor, 1, now_s);
    return 0;
}
