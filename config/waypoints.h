/* Waypoint files: where a vehicle is when, a line each. */
#ifndef JOLON_CONFIG_WAYPOINTS_H
#define JOLON_CONFIG_WAYPOINTS_H

#include "config/loader.h"
#include "config/source.h"

#define WAYPOINTS_BYTES_MAX (4u * 1024u * 1024u)
#define WAYPOINTS_HEADER    "time_s,x,z[,altitude_m]"

/* Lines of the text that are not empty: an upper bound of its waypoints, for allocation. */
uint32_t waypoints_lines(const char *text);

/* Reads "time_s,x,z[,altitude_m]" and the lines behind it into steps, which have room for
 * waypoints_lines(). Times ascend, points are on the map. How many there are; -1 with the message
 * of the line and what would be right. */
int waypoints_read(const struct source *source, struct scenario_step *steps,
                   struct loader_message *message);

#endif
