/* Where a world lies on the earth. */
#include "world/earth_location.h"

void earth_location_frame(struct location_frame *frame, const struct params *params, double side_m)
{
    location_frame_make(frame, params->gateway.latitude_deg, params->gateway.longitude_deg, side_m);
}
