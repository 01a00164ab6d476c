/* Where a world lies on the earth. */
#include "world/earth_place.h"

#include "world/terrain/gridsquare.h"

void earth_place_frame(struct place_frame *frame, const struct params *params)
{
    place_frame_make(frame, params->gateway.latitude_deg, params->gateway.longitude_deg,
                     WORLD_SIDE_M);
}
