/* Reader of files of waypoints. A line has a time and the place where the vehicle is then. */
#ifndef JOLON_CONFIG_WAYPOINTS_H
#define JOLON_CONFIG_WAYPOINTS_H

#include "config/syntax/source.h"
#include "world/terrain/location.h"

#include <stdint.h>

struct scenario_step;

#define WAYPOINTS_BYTES_MAX (4u * 1024u * 1024u)
#define WAYPOINTS_HEADER                                                                           \
    "time_s,x,z[,altitude_m], with latitude,longitude or mgrs instead of x,z if it has these"

/* Returns the number of lines that are not empty, which is an upper bound of the waypoints. */
uint32_t waypoints_lines(const char *text);

/* Reads the header and the lines after it into steps, which have room for waypoints_lines(). frame:
 * where the world lies. Times must increase, and places must be in the world. Returns the number of
 * waypoints; -1 with the message. */
int waypoints_read(const struct source *source, const struct location_frame *frame,
                   struct scenario_step *steps, struct error_text *error);

#endif
