/* Keys and what they change. */
#include "clients/monitor/screen_state.h"

#include "world/maths/maths.h"

#include <string.h>

#define PAN_SHARE 0.25 /* of what the map shows */

void screen_state_begin(struct screen_state *desk, double side_m)
{
    *desk = (struct screen_state){.x = 0.5 * side_m, .z = 0.5 * side_m, .page_rows = 1};
}

static double across(const struct screen_state *desk, double side_m)
{
    return side_m / (double)(1 << desk->zoom);
}

static void type(struct screen_state *desk, int key)
{
    char *filter = desk->filter[desk->page];
    size_t length = strlen(filter);
    if (key == SCREEN_STATE_ENTER) {
        desk->typing = false;
    } else if (key == SCREEN_STATE_ESCAPE) {
        filter[0] = '\0';
        desk->typing = false;
    } else if (key == SCREEN_STATE_BACKSPACE && length > 0) {
        filter[length - 1] = '\0';
    } else if (key >= ' ' && key < 127 && length + 1 < VEHICLE_TABLE_FILTER_MAX) {
        filter[length] = (char)key;
        filter[length + 1] = '\0';
    }
    desk->first = 0;
    desk->back = 0;
}

static void sort_by(struct screen_state *desk, int step)
{
    desk->sort = (enum vehicle_table_column)(((int)desk->sort + step + VEHICLE_TABLE_COLUMNS) %
                                             VEHICLE_TABLE_COLUMNS);
}

static int key_of_vehicles(struct screen_state *desk, int key)
{
    const int page = (int)desk->page_rows, all = (int)desk->table_count;
    switch (key) {
    case 's':
    case SCREEN_STATE_RIGHT:
        sort_by(desk, 1);
        return 0;
    case 'S':
    case SCREEN_STATE_LEFT:
        sort_by(desk, -1);
        return 0;
    case 'r':
        desk->descending = !desk->descending;
        return 0;
    case 'm':
    case SCREEN_STATE_ENTER:
        desk->follow = desk->chosen != 0;
        desk->zoom = desk->follow && desk->zoom < 4 ? 4 : desk->zoom;
        desk->page = SCREEN_STATE_MAP;
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

static void key_of_events(struct screen_state *desk, int key)
{
    uint64_t page = desk->page_rows > 1 ? desk->page_rows - 1 : 1;
    if (key == SCREEN_STATE_UP)
        desk->back++;
    else if (key == SCREEN_STATE_DOWN)
        desk->back -= desk->back > 0;
    else if (key == SCREEN_STATE_PAGE_UP)
        desk->back += page;
    else if (key == SCREEN_STATE_PAGE_DOWN)
        desk->back -= desk->back < page ? desk->back : page;
    else if (key == SCREEN_STATE_END)
        desk->back = 0;
    else if (key == SCREEN_STATE_HOME)
        desk->back = UINT32_MAX; /* drawing stops at the oldest */
}

static void key_of_map(struct screen_state *desk, int key, double side_m)
{
    double step = PAN_SHARE * across(desk, side_m);
    double x = desk->x, z = desk->z;
    if (key == '+' || key == '=')
        desk->zoom += desk->zoom < SCREEN_STATE_ZOOM_MAX;
    else if (key == '-')
        desk->zoom -= desk->zoom > 0;
    else if (key == '0' || key == SCREEN_STATE_HOME)
        desk->zoom = 0;
    else if (key == 'f')
        desk->follow = !desk->follow && desk->chosen != 0;
    x += key == SCREEN_STATE_RIGHT ? step : key == SCREEN_STATE_LEFT ? -step : 0.0;
    z += key == SCREEN_STATE_DOWN ? step : key == SCREEN_STATE_UP ? -step : 0.0;
    if (key >= SCREEN_STATE_UP && key <= SCREEN_STATE_RIGHT)
        desk->follow = false;
    if (desk->zoom == 0)
        x = z = 0.5 * side_m;
    desk->x = maths_clamp(x, 0.0, side_m);
    desk->z = maths_clamp(z, 0.0, side_m);
}

int screen_state_key(struct screen_state *desk, int key, double side_m)
{
    if (desk->typing) {
        type(desk, key);
        return 0;
    }
    if (key >= '1' && key < '1' + SCREEN_STATE_HELP) {
        desk->page = (enum screen_state_page)(key - '1');
    } else if (key == SCREEN_STATE_TAB) {
        desk->page = (enum screen_state_page)((desk->page + 1) % SCREEN_STATE_HELP);
    } else if (key == '?' || key == 'h') {
        desk->page = desk->page == SCREEN_STATE_HELP ? SCREEN_STATE_ALL : SCREEN_STATE_HELP;
    } else if (key == 'q' || key == 'Q') {
        desk->quit = true;
    } else if (key == SCREEN_STATE_ESCAPE) {
        desk->quit = desk->page == SCREEN_STATE_ALL;
        desk->page = SCREEN_STATE_ALL;
    } else if (key == '/' &&
               (desk->page == SCREEN_STATE_VEHICLES || desk->page == SCREEN_STATE_EVENTS)) {
        desk->typing = true;
    } else if (desk->page == SCREEN_STATE_VEHICLES) {
        return key_of_vehicles(desk, key);
    } else if (desk->page == SCREEN_STATE_EVENTS) {
        key_of_events(desk, key);
    } else if (desk->page == SCREEN_STATE_MAP || desk->page == SCREEN_STATE_ALL) {
        key_of_map(desk, key, side_m);
    }
    return 0;
}

void screen_state_table(struct screen_state *desk, const struct vehicle_table *table,
                        const struct world_mirror *mirror, uint32_t page_rows)
{
    uint32_t rows = page_rows > 0 ? page_rows : 1;
    desk->page_rows = rows;
    desk->table_count = table->count;
    desk->chosen_row =
        desk->chosen ? vehicle_table_find(table, mirror, desk->chosen) : table->count;
    uint32_t last = table->count > rows ? table->count - rows : 0;
    if (desk->chosen_row < table->count) {
        if (desk->first > desk->chosen_row)
            desk->first = desk->chosen_row;
        if (desk->first + rows <= desk->chosen_row)
            desk->first = desk->chosen_row - rows + 1;
    }
    desk->first = desk->first < last ? desk->first : last;
}

void screen_state_choose(struct screen_state *desk, const struct vehicle_table *table,
                         const struct world_mirror *mirror, int rows)
{
    if (rows == 0 || table->count == 0)
        return;
    int64_t last = (int64_t)table->count - 1;
    int64_t at =
        desk->chosen_row < table->count ? (int64_t)desk->chosen_row + rows : (int64_t)desk->first;
    at = at < 0 ? 0 : at > last ? last : at;
    desk->chosen = mirror->batch.entity[table->row[at]].id;
}

struct character_map_area screen_state_area(struct screen_state *desk,
                                            const struct world_mirror *mirror, double side_m)
{
    for (uint32_t i = 0; desk->follow && mirror->has_batch && i < mirror->batch.count; i++) {
        if (mirror->batch.entity[i].id == desk->chosen) {
            desk->x = mirror->batch.entity[i].x_m;
            desk->z = mirror->batch.entity[i].z_m;
            break;
        }
    }
    return (struct character_map_area){desk->x, desk->z, across(desk, side_m)};
}
