/* Grids of the height of the sea level above the ellipsoid (undulation), in PROJ's format GTX: a
 * header of 40 octets, then rows from the south to the north, each from the west to the east. */
#ifndef JOLON_GATEWAY_EARTH_GEOID_GRID_H
#define JOLON_GATEWAY_EARTH_GEOID_GRID_H

#include "world/runtime/error_text.h"

/* EGM96 every 15 minutes of arc, as PROJ uses it for the heights of EPSG:5773. */
#define GEOID_GRID_FOLDER "/usr/share/proj"
#define GEOID_GRID_NAME   "egm96_15.gtx"
#define GEOID_GRID_PATH   GEOID_GRID_FOLDER "/" GEOID_GRID_NAME

/* Reads the undulation [m] at a place [degrees] from a file, linear between the four nodes around
 * it, as PROJ does. Returns 0, or -1 with the reason, which names the file. */
int geoid_grid_read(const char *path, double latitude_deg, double longitude_deg,
                    double *undulation_m, struct error_text *error);

#endif
