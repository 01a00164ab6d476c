/* How keys change the state. */
#include "clients/monitor/screen_state.h"

#include "world/maths/maths.h"

#include <string.h>

#define PAN_SHARE 0.25 /* of what the map shows */

void screen_state_begin(struct screen_state *state, double side_m)
{
    *state = (struct screen_state){.x = 0.5 * side_m, .z = 0.5 * side_m, .page_rows = 1};
}

static double across(const struct screen_state *state, double side_m)
{
    return side_m / (double)(1 << state->zoom);
}

static void edit_filter(struct screen_state *state, int key)
{
    char *filter = state->filter[state->page];
    size_t length = strlen(filter);
    if (key == SCREEN_STATE_ENTER) {
        state->typing = false;
    } else if (key == SCREEN_STATE_ESCAPE) {
        filter[0] = '\0';
        state->typing = false;
    } else if (key == SCREEN_STATE_BACKSPACE && length > 0) {
        filter[length - 1] = '\0';
    } else if (key >= ' ' && key < 127 && length + 1 < VEHICLE_TABLE_FILTER_MAX) {
        filter[length] = (char)key;
        filter[length + 1] = '\0';
    }
    state->first = 0;
    state->back = 0;
}

static void sort_by(struct screen_state *state, int step)
{
    state->sort = (enum vehicle_table_column)(((int)state->sort + step + VEHICLE_TABLE_COLUMNS) %
                                              VEHICLE_TABLE_COLUMNS);
}

static int vehicles_key(struct screen_state *state, int key)
{
    const int page = (int)state->page_rows, all = (int)state->table_count;
    switch (key) {
    case 's':
    case SCREEN_STATE_RIGHT:
        sort_by(state, 1);
        return 0;
    case 'S':
    case SCREEN_STATE_LEFT:
        sort_by(state, -1);
        return 0;
    case 'r':
        state->descending = !state->descending;
        return 0;
    case 'm':
    case SCREEN_STATE_ENTER:
        state->follow = state->selected != 0;
        state->zoom = state->follow && state->zoom < 4 ? 4 : state->zoom;
        state->page = SCREEN_STATE_MAP;
        return 0;
    case SCREEN_STATE_UP:
        return -1;
    case SCREEN_STATE_DOWN:
        return 1;
    case SCREEN_STATE_PAGE_UP:
        return -page;
    case SCREEN_STATE_PAGE_DOWN:
        return page;
    case SCREEN_STATE_HOME:
        return -all;
    case SCREEN_STATE_END:
        return all;
    default:
        return 0;
    }
}

static void events_key(struct screen_state *state, int key)
{
    uint64_t page = state->page_rows > 1 ? state->page_rows - 1 : 1;
    if (key == SCREEN_STATE_UP)
        state->back++;
    else if (key == SCREEN_STATE_DOWN)
        state->back -= state->back > 0;
    else if (key == SCREEN_STATE_PAGE_UP)
        state->back += page;
    else if (key == SCREEN_STATE_PAGE_DOWN)
        state->back -= state->back < page ? state->back : page;
    else if (key == SCREEN_STATE_END)
        state->back = 0;
    else if (key == SCREEN_STATE_HOME)
        state->back = UINT32_MAX; /* drawing limits it to the oldest event */
}

static void map_key(struct screen_state *state, int key, double side_m)
{
    double step = PAN_SHARE * across(state, side_m);
    double x = state->x, z = state->z;
    if (key == '+' || key == '=')
        state->zoom += state->zoom < SCREEN_STATE_ZOOM_MAX;
    else if (key == '-')
        state->zoom -= state->zoom > 0;
    else if (key == '0' || key == SCREEN_STATE_HOME)
        state->zoom = 0;
    else if (key == 'f')
        state->follow = !state->follow && state->selected != 0;
    x += key == SCREEN_STATE_RIGHT ? step : key == SCREEN_STATE_LEFT ? -step : 0.0;
    z += key == SCREEN_STATE_DOWN ? step : key == SCREEN_STATE_UP ? -step : 0.0;
    if (key >= SCREEN_STATE_UP && key <= SCREEN_STATE_RIGHT)
        state->follow = false;
    if (state->zoom == 0)
        x = z = 0.5 * side_m;
    state->x = maths_clamp(x, 0.0, side_m);
    state->z = maths_clamp(z, 0.0, side_m);
}

int screen_state_key(struct screen_state *state, int key, double side_m)
{
    if (state->typing) {
        edit_filter(state, key);
        return 0;
    }
    if (key >= '1' && key < '1' + SCREEN_STATE_HELP) {
        state->page = (enum screen_state_page)(key - '1');
    } else if (key == SCREEN_STATE_TAB) {
        state->page = (enum screen_state_page)((state->page + 1) % SCREEN_STATE_HELP);
    } else if (key == '?' || key == 'h') {
        state->page = state->page == SCREEN_STATE_HELP ? SCREEN_STATE_ALL : SCREEN_STATE_HELP;
    } else if (key == 'q' || key == 'Q') {
        state->quit = true;
    } else if (key == SCREEN_STATE_ESCAPE) {
        state->quit = state->page == SCREEN_STATE_ALL;
        state->page = SCREEN_STATE_ALL;
    } else if (key == '/' &&
               (state->page == SCREEN_STATE_VEHICLES || state->page == SCREEN_STATE_EVENTS)) {
        state->typing = true;
    } else if (state->page == SCREEN_STATE_VEHICLES) {
        return vehicles_key(state, key);
    } else if (state->page == SCREEN_STATE_EVENTS) {
        events_key(state, key);
    } else if (state->page == SCREEN_STATE_MAP || state->page == SCREEN_STATE_ALL) {
        map_key(state, key, side_m);
    }
    return 0;
}

void screen_state_table(struct screen_state *state, const struct vehicle_table *table,
                        const struct world_mirror *mirror, uint32_t page_rows)
{
    uint32_t rows = page_rows > 0 ? page_rows : 1;
    state->page_rows = rows;
    state->table_count = table->count;
    state->selected_row =
        state->selected ? vehicle_table_find(table, mirror, state->selected) : table->count;
    uint32_t last = table->count > rows ? table->count - rows : 0;
    if (state->selected_row < table->count) {
        if (state->first > state->selected_row)
            state->first = state->selected_row;
        if (state->first + rows <= state->selected_row)
            state->first = state->selected_row - rows + 1;
    }
    state->first = state->first < last ? state->first : last;
}

void screen_state_select(struct screen_state *state, const struct vehicle_table *table,
                         const struct world_mirror *mirror, int rows)
{
    if (rows == 0 || table->count == 0)
        return;
    int64_t last = (int64_t)table->count - 1;
    int64_t at = state->selected_row < table->count ? (int64_t)state->selected_row + rows
                                                    : (int64_t)state->first;
    at = at < 0 ? 0 : at > last ? last : at;
    state->selected = mirror->batch.entity[table->row[at]].id;
}

struct character_map_area screen_state_area(struct screen_state *state,
                                            const struct world_mirror *mirror, double side_m)
{
    for (uint32_t i = 0; state->follow && mirror->has_batch && i < mirror->batch.count; i++) {
        if (mirror->batch.entity[i].id == state->selected) {
            state->x = mirror->batch.entity[i].x_m;
            state->z = mirror->batch.entity[i].z_m;
            break;
        }
    }
    return (struct character_map_area){state->x, state->z, across(state, side_m)};
}
