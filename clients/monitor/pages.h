/* Draws the pages of the screen, each in the given rows. Curses must be open. */
#ifndef JOLON_CLIENTS_MONITOR_PAGES_H
#define JOLON_CLIENTS_MONITOR_PAGES_H

#include "clients/monitor/screen.h"

/* The overview: the status above, the map and the latest events below. */
void pages_all(struct screen *screen, const struct world_mirror *mirror, int top, int rows);
void pages_vehicles(struct screen *screen, const struct world_mirror *mirror, int top, int rows);
void pages_events(struct screen *screen, int top, int rows);
void pages_map(struct screen *screen, const struct world_mirror *mirror, int top, int rows);
void pages_help(int top, int rows);

#endif
