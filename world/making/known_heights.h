/* Sets the known heights of the terrain: summits, places, the lake. */
#ifndef JOLON_WORLD_MAKING_KNOWN_HEIGHTS_H
#define JOLON_WORLD_MAKING_KNOWN_HEIGHTS_H

#include "world/making/elevation_grid.h"
#include "world/making/elevation_fields.h"

/* Changes heights and roughness around the anchors, and marks the lake. The first anchor that is a
 * peak is the highest of the world. Returns 0, or -1 with errno ENOMEM. */
int known_heights_set(struct elevation_grid *grid,
                      const struct anchor anchors[GEOGRAPHY_PLACE_COUNT]);

#endif
