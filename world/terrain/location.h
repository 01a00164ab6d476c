/* A place as people write it, for every door of a world: scenarios, command lines, JSON, the page.
 *
 *     25000,24000            metres east and south of the north-west corner
 *     44.2705N,71.3033W      latitude and longitude on WGS 84, in degrees
 *     19TCK1617404497        a reference of the Military Grid Reference System (mgrs.h)
 *
 * A place on the earth becomes one of the world by the projection of ground files (projection.h)
 * about the world's place, also where the ground is of no file. Pure; any thread. */
#ifndef JOLON_WORLD_TERRAIN_LOCATION_H
#define JOLON_WORLD_TERRAIN_LOCATION_H

#include "world/runtime/error_text.h"
#include "world/terrain/mgrs.h"
#include "world/terrain/projection.h"

#include <stdbool.h>

#define LOCATION_TEXT_MAX 32 /* [byte] of a latitude and a longitude, with the NUL */

struct location {
    bool on_earth;                      /* else x and z hold */
    double x, z;                        /* [m] */
    double latitude_deg, longitude_deg; /* WGS 84 */
};

/* Where a world lies on the earth. */
struct location_frame {
    double latitude_deg, longitude_deg; /* of the middle */
    double side_m;
    struct projection projection;
};

void location_frame_make(struct location_frame *frame, double latitude_deg, double longitude_deg,
                         double side_m);

/* Reads a place in one of the three forms. Returns 0, or -1 with the reason: what is wrong and what
 * would be right. Metres are any decimal numbers from 0 on. */
int location_read(struct location *place, const char *text, struct error_text *error);

/* Gives a place's coordinates in the world [m]. Returns 0, or -1 with the reason if it lies outside
 * of the world's square. */
int location_world(const struct location *place, const struct location_frame *frame, double *x,
                   double *z, struct error_text *error);

/* The same place of a world [m] on the earth: degrees; as "44.270500N,71.303300W", to 0.1 m; and as
 * a reference of the grid, "" where there is none. */
struct location_earth {
    double latitude_deg, longitude_deg;
    char degrees[LOCATION_TEXT_MAX];
    char mgrs[MGRS_TEXT_MAX];
};
void location_earth(struct location_earth *earth, const struct location_frame *frame, double x,
                    double z);

#endif
