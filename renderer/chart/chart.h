/* Pictures with words: the map with its close-up, legend and figures, and the instruments laid over
 * a camera's picture. */
#ifndef JOLON_RENDERER_CHART_H
#define JOLON_RENDERER_CHART_H

#include "renderer/chart/map.h"
#include "renderer/scene/statistics.h"
#include "renderer/image/text.h"

#include <stdint.h>

struct chart {
    struct text *text; /* owned */
    const struct world *world;
    struct image whole, small; /* ground of the whole square, for the map and the instruments */
    struct image close_up;     /* ground around the followed vehicle, painted anew each time */
    uint32_t width, height;    /* of the pictures */
};

/* 0, or -1 with the reason. Takes some tenths of a second. */
int chart_open(struct chart *chart, const struct world *world, uint32_t width, uint32_t height,
               struct reason *reason);
void chart_close(struct chart *chart);

/* The map as a picture. slot: the followed vehicle, SLOT_NONE for none. 0, or -1 with errno. */
int chart_map(struct chart *chart, struct image *image, const struct moment *moment,
              const struct tracks *tracks, uint32_t slot);

/* The statistics bar below and a small map in the corner of a camera's picture. */
void chart_instruments(struct chart *chart, struct image *image, const struct moment *moment,
                       const struct tracks *tracks, uint32_t slot);

#endif
