/* Where a world lies on the earth. */
#include "world/earth_location.h"

#include "world/terrain/gridsquare.h"

void earth_location_frame(struct location_frame *frame, const struct params *params)
{
    location_frame_make(frame, params->gateway.latitude_deg, params->gateway.longitude_deg,
                        WORLD_SIDE_M);
}
