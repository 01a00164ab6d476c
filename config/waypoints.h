/* Reader of files of waypoints. A line has a time and the place where the vehicle is then. */
#ifndef JOLON_CONFIG_WAYPOINTS_H
#define JOLON_CONFIG_WAYPOINTS_H

#include "config/syntax/source.h"

#include <stdint.h>

struct scenario_step;

#define WAYPOINTS_BYTES_MAX (4u * 1024u * 1024u)
#define WAYPOINTS_HEADER    "time_s,x,z[,altitude_m]"

/* Returns the number of lines that are not empty, which is an upper bound of the waypoints. */
uint32_t waypoints_lines(const char *text);

/* Reads the header and the lines after it into steps, which have room for waypoints_lines(). Times
 * must increase, and points must be on the map. Returns the number of waypoints; -1 with the
 * message.
 */
int waypoints_read(const struct source *source, struct scenario_step *steps,
                   struct error_text *error);

#endif
