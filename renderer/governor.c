/* Levels, and when to change them. */
#include "renderer/governor.h"

#include <math.h>
#include <stdbool.h>

const struct governor_level governor_levels[GOVERNOR_LEVELS] = {
    {1.0, 4}, {0.7, 4}, {0.5, 4}, {0.35, 4}, {0.35, 3}, {0.35, 2},
};

void governor_init(struct governor *governor, double fps)
{
    *governor = (struct governor){.interval_s = fps > 0.0 ? 1.0 / fps : 0.0,
                                  .patience_s = GOVERNOR_PATIENCE_S,
                                  .raised_s = -INFINITY};
}

double governor_median_s(const struct governor *governor)
{
    double sorted[GOVERNOR_PICTURES];
    if (governor->count < GOVERNOR_PICTURES)
        return 0.0;
    for (uint32_t i = 0; i < GOVERNOR_PICTURES; i++) {
        uint32_t place = i;
        for (; place > 0 && sorted[place - 1] > governor->took_s[i]; place--)
            sorted[place] = sorted[place - 1];
        sorted[place] = governor->took_s[i];
    }
    return sorted[GOVERNOR_PICTURES / 2];
}

static int change(struct governor *governor, int by, double now_s)
{
    governor->judged_s = governor_median_s(governor);
    governor->level = by < 0 ? governor->level + 1 : governor->level - 1;
    governor->count = 0;
    governor->idle_since_s = now_s;
    if (by > 0) {
        governor->raised_s = now_s;
        return by;
    }
    /* Twice the patience when the rise was too much; else it is a new load, and as at first. */
    bool too_much = now_s - governor->raised_s < GOVERNOR_TRIAL_S;
    governor->patience_s =
        too_much ? fmin(2.0 * governor->patience_s, GOVERNOR_LONGEST_S) : GOVERNOR_PATIENCE_S;
    return by;
}

int governor_note(struct governor *governor, double took_s, double now_s)
{
    if (governor->interval_s <= 0.0)
        return 0;
    governor->took_s[governor->count % GOVERNOR_PICTURES] = took_s;
    governor->count++;
    double median_s = governor_median_s(governor);
    if (governor->count < GOVERNOR_PICTURES || median_s > GOVERNOR_IDLE * governor->interval_s)
        governor->idle_since_s = now_s;
    if (median_s > GOVERNOR_BUSY * governor->interval_s && governor->level + 1 < GOVERNOR_LEVELS)
        return change(governor, -1, now_s);
    if (governor->level > 0 && now_s - governor->idle_since_s >= governor->patience_s)
        return change(governor, 1, now_s);
    return 0;
}
