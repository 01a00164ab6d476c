/* The pages of the screen, each in the rows that it is given. Curses must be open. */
#ifndef JOLON_CLIENTS_MONITOR_PAGES_H
#define JOLON_CLIENTS_MONITOR_PAGES_H

#include "clients/monitor/screen.h"

/* Colours that people who do not tell red from green tell apart; letters say the same. */
enum pages_pair { PAIR_PLAIN, PAIR_BLUE, PAIR_RED, PAIR_WATER, PAIR_WARN };

/* One row's text from column on, cut at the edge; attributes are curses'. */
void pages_put(int row, int column, const char *text, unsigned attributes, enum pages_pair pair);

/* The world in general above, the map and the latest events below. */
void pages_all(struct screen *screen, const struct world_mirror *mirror, int top, int rows);
void pages_vehicles(struct screen *screen, const struct world_mirror *mirror, int top, int rows);
void pages_events(struct screen *screen, int top, int rows);
void pages_map(struct screen *screen, const struct world_mirror *mirror, int top, int rows);
void pages_help(int top, int rows);

#endif
