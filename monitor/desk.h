/* The desk: what somebody at the screen looks at, and what a key makes of that. Pure. */
#ifndef JOLON_MONITOR_DESK_H
#define JOLON_MONITOR_DESK_H

#include "monitor/map.h"
#include "monitor/table.h"

#include <stdbool.h>
#include <stdint.h>

enum desk_page { DESK_ALL, DESK_VEHICLES, DESK_EVENTS, DESK_MAP, DESK_HELP, DESK_PAGES };

/* Keys that are no characters. */
enum desk_key {
    DESK_UP = 256,
    DESK_DOWN,
    DESK_LEFT,
    DESK_RIGHT,
    DESK_PAGE_UP,
    DESK_PAGE_DOWN,
    DESK_HOME,
    DESK_END,
    DESK_ENTER,
    DESK_BACKSPACE,
    DESK_ESCAPE,
    DESK_TAB
};

#define DESK_ZOOM_MAX 9 /* times two: 50 km down to 98 m */

struct desk {
    enum desk_page page;
    bool quit;
    bool typing; /* the page's filter is being typed */
    char filter[DESK_PAGES][TABLE_FILTER_MAX];
    enum table_column sort;
    bool descending;
    uint32_t chosen;      /* id of a vehicle, 0: none */
    bool follow;          /* the map stays about the chosen one */
    uint32_t first;       /* row of the table at the top */
    uint64_t back;        /* events between the last one shown and the newest */
    double x, z;          /* [m] the map's middle */
    int zoom;             /* 0: the whole square */
    uint32_t page_rows;   /* what the screen had room for when it was last drawn */
    uint32_t chosen_row;  /* of the table; its count when the chosen one is not in it */
    uint32_t table_count; /* rows of it */
};

/* As it is at the start, of a world of side_m. */
void desk_begin(struct desk *desk, double side_m);

/* What a key does: a character, or an enum desk_key. Returns the way that the choice moves in the
 * table: 0, or rows down or up; the caller knows the ids. */
int desk_key(struct desk *desk, int key, double side_m);

/* After the table was built: the chosen one's row, and the row at the top moved so that it shows.
 */
void desk_table(struct desk *desk, const struct table *table, const struct mirror *mirror,
                uint32_t page_rows);

/* Moves the choice by rows in the table. */
void desk_choose(struct desk *desk, const struct table *table, const struct mirror *mirror,
                 int rows);

/* What the map shows; about the chosen one when it is followed and there. */
struct map_area desk_area(struct desk *desk, const struct mirror *mirror, double side_m);

#endif
