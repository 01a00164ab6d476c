/* The state of the screen: page, filters, sorting, selection, map; and how keys change it. Pure. */
#ifndef JOLON_CLIENTS_MONITOR_SCREEN_STATE_H
#define JOLON_CLIENTS_MONITOR_SCREEN_STATE_H

#include "clients/monitor/character_map.h"
#include "clients/monitor/vehicle_table.h"

#include <stdbool.h>
#include <stdint.h>

enum screen_state_page {
    SCREEN_STATE_ALL,
    SCREEN_STATE_VEHICLES,
    SCREEN_STATE_EVENTS,
    SCREEN_STATE_MAP,
    SCREEN_STATE_HELP,
    SCREEN_STATE_PAGES
};

/* Keys that are not characters. */
enum screen_state_key {
    SCREEN_STATE_UP = 256,
    SCREEN_STATE_DOWN,
    SCREEN_STATE_LEFT,
    SCREEN_STATE_RIGHT,
    SCREEN_STATE_PAGE_UP,
    SCREEN_STATE_PAGE_DOWN,
    SCREEN_STATE_HOME,
    SCREEN_STATE_END,
    SCREEN_STATE_ENTER,
    SCREEN_STATE_BACKSPACE,
    SCREEN_STATE_ESCAPE,
    SCREEN_STATE_TAB
};

#define SCREEN_STATE_ZOOM_MAX 9 /* each step halves the width: 50 km down to 98 m */

struct screen_state {
    enum screen_state_page page;
    bool quit;
    bool typing; /* the page's filter is being typed */
    char filter[SCREEN_STATE_PAGES][VEHICLE_TABLE_FILTER_MAX];
    enum vehicle_table_column sort;
    bool descending;
    uint32_t selected;     /* id of a vehicle, 0: none */
    bool follow;           /* the map stays centred on the selected vehicle */
    uint32_t first;        /* row of the table at the top */
    uint64_t back;         /* events between the last one shown and the newest */
    double x, z;           /* [m] the map's centre */
    int zoom;              /* 0: the whole world */
    uint32_t page_rows;    /* rows of the page when it was last drawn */
    uint32_t selected_row; /* in the table; table_count if it is not in the table */
    uint32_t table_count;  /* rows of the table */
};

/* Sets the state for the start, in a world of side_m. */
void screen_state_begin(struct screen_state *state, double side_m);

/* Handles a key: a character or an enum screen_state_key. Returns by how many rows the selection
 * is to move down (positive) or up; the caller then calls screen_state_select(). */
int screen_state_key(struct screen_state *state, int key, double side_m);

/* Called after the table was built: finds the row of the selected vehicle and scrolls so that it is
 * visible. */
void screen_state_table(struct screen_state *state, const struct vehicle_table *table,
                        const struct world_mirror *mirror, uint32_t page_rows);

/* Moves the selection by rows in the table. */
void screen_state_select(struct screen_state *state, const struct vehicle_table *table,
                         const struct world_mirror *mirror, int rows);

/* Returns the area that the map shows, after centring it on a vehicle that is followed. */
struct character_map_area screen_state_area(struct screen_state *state,
                                            const struct world_mirror *mirror, double side_m);

#endif
