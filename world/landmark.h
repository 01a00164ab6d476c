/* Sets what is known of the land exactly: the summits, the heights of places, the lake. */
#ifndef JOLON_WORLD_LANDMARK_H
#define JOLON_WORLD_LANDMARK_H

#include "world/land.h"
#include "world/sketch.h"

/* Changes heights and roughness around the anchors, marks the lake. Of the anchors that are peaks
 * the first is the highest of the world. 0, or -1 with errno ENOMEM. */
int landmark_set(struct land *land, const struct anchor anchors[GEOGRAPHY_PLACE_COUNT]);

#endif
