/* Places as references of the Military Grid Reference System: "19TCK1617404497" is a square of 1 m
 * on the summit of Mount Washington.
 *
 * Source: NGA.STND.0037, Universal Grids and Grid Reference Systems (2014), for the zones with
 * their exceptions off Norway and Svalbard, the bands and the letters of WGS 84; the projection of
 * a zone is that of projection.h with the scale 0.9996 and 500 km added to the east. The caps
 * beyond 84 degrees north and 80 south, which have a grid of their own, are refused. Uses
 * world/maths alone, so the results are the same on every machine. Pure; any thread. */
#ifndef JOLON_WORLD_TERRAIN_MGRS_H
#define JOLON_WORLD_TERRAIN_MGRS_H

#include "world/runtime/error_text.h"

#include <stdbool.h>

#define MGRS_TEXT_MAX 16 /* [byte] of a reference to 1 m, with the NUL */

/* Reads a reference with none to five digits for each direction, with or without blanks, in
 * letters of either case. The place [deg] is the middle of the square that is named. Returns 0, or
 * -1 with the reason: what is wrong and what would be right. */
int mgrs_read(const char *text, double *latitude_deg, double *longitude_deg,
              struct error_text *error);

/* Writes the square of 1 m that has a place [deg], without blanks. Returns false, with "" for the
 * text, where the grid does not reach. */
bool mgrs_write(char text[MGRS_TEXT_MAX], double latitude_deg, double longitude_deg);

#endif
