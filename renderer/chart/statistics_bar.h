/* The statistics bar in words (thesis row 13): what stands in each of its fields, and which of them
 * are alarms. Pure. */
#ifndef JOLON_RENDERER_CHART_STATISTICS_BAR_H
#define JOLON_RENDERER_CHART_STATISTICS_BAR_H

#include "renderer/scene/frame/statistics.h"

#include <stdint.h>

#define STATISTICS_BAR_MAX        12u
#define STATISTICS_BAR_RANK_SPARE 11u /* a field of this rank goes rather than cost another row */

enum statistics_bar_state {
    STATISTICS_BAR_GOOD,
    STATISTICS_BAR_PLAIN,
    STATISTICS_BAR_WARNING,
    STATISTICS_BAR_ALARM
};

struct statistics_bar_field {
    const char *name;
    const char *widest; /* no value is wider, nearly: fields keep their places */
    char value[32];
    uint32_t state; /* enum statistics_bar_state */
    uint32_t rank;  /* where not all have room, the highest go first */
};

/* Fills the fields in the order in which they are read; fps: 0 when it is not known. Returns how
 * many. */
uint32_t statistics_bar_of(struct statistics_bar_field fields[STATISTICS_BAR_MAX],
                           const struct statistics *statistics, double fps);

#endif
