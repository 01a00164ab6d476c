/* Draws the pages of the screen, each in the given rows. Curses must be open. */
#ifndef JOLON_CLIENTS_MONITOR_PAGES_H
#define JOLON_CLIENTS_MONITOR_PAGES_H

#include "clients/monitor/screen.h"

/* Colours that colour-blind people tell apart. The map's letters show the force as well. */
enum pages_pair { PAIR_PLAIN, PAIR_BLUE, PAIR_RED, PAIR_WATER, PAIR_WARN };

/* Writes text in a row from column on, cut at the edge. attributes: of curses. */
void pages_put(int row, int column, const char *text, unsigned attributes, enum pages_pair pair);

/* The overview: the status above, the map and the latest events below. */
void pages_all(struct screen *screen, const struct world_mirror *mirror, int top, int rows);
void pages_vehicles(struct screen *screen, const struct world_mirror *mirror, int top, int rows);
void pages_events(struct screen *screen, int top, int rows);
void pages_map(struct screen *screen, const struct world_mirror *mirror, int top, int rows);
void pages_help(int top, int rows);

#endif
