/* The fields of the statistics bar (thesis row 13), and which of them are warnings or alarms.
 * Pure. */
#ifndef JOLON_RENDERER_CHART_STATISTICS_BAR_H
#define JOLON_RENDERER_CHART_STATISTICS_BAR_H

#include "renderer/scene/frame/statistics.h"

#include <stdint.h>

#define STATISTICS_BAR_MAX        12u
#define STATISTICS_BAR_RANK_SPARE 11u /* left out if it alone would need another row */

enum statistics_bar_state {
    STATISTICS_BAR_GOOD,
    STATISTICS_BAR_PLAIN,
    STATISTICS_BAR_WARNING,
    STATISTICS_BAR_ALARM
};

struct statistics_bar_field {
    const char *name;
    const char *widest; /* hardly any value is wider, so that fields keep their places */
    char value[32];
    uint32_t state; /* enum statistics_bar_state */
    uint32_t rank;  /* where there is no room, the highest is left out first */
};

/* Fills the fields from left to right. fps: 0 when it is not known. Returns how many there are. */
uint32_t statistics_bar_of(struct statistics_bar_field fields[STATISTICS_BAR_MAX],
                           const struct statistics *statistics, double fps);

#endif
