/* Where a world lies on the earth, for those who read and write places (world/terrain/location.h).
 * Pure; any thread. */
#ifndef JOLON_WORLD_EARTH_LOCATION_H
#define JOLON_WORLD_EARTH_LOCATION_H

#include "world/params.h"
#include "world/terrain/location.h"

/* The middle is at gateway.latitude_deg and gateway.longitude_deg, which are those of the ground
 * file unless the scenario gives others. side_m: of the world. */
void earth_location_frame(struct location_frame *frame, const struct params *params, double side_m);

#endif
