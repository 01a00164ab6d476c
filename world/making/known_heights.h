/* Sets what is known of the land exactly: the summits, the heights of places, the lake. */
#ifndef JOLON_WORLD_MAKING_KNOWN_HEIGHTS_H
#define JOLON_WORLD_MAKING_KNOWN_HEIGHTS_H

#include "world/making/elevation_grid.h"
#include "world/making/elevation_fields.h"

/* Changes heights and roughness around the anchors, marks the lake. Of the anchors that are peaks
 * the first is the highest of the world. 0, or -1 with errno ENOMEM. */
int known_heights_set(struct elevation_grid *grid,
                      const struct anchor anchors[GEOGRAPHY_PLACE_COUNT]);

#endif
