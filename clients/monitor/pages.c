/* The contents of the pages. */
#include "clients/monitor/pages.h"

#include "clients/curses_text.h"
#include "clients/monitor/status_lines.h"

#include <curses.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* Columns reserved for the events beside the map. */
#define EVENT_COLUMNS_MIN 40

/* --- the map -----------------------------------------------------------------------------------*/

static char mark_of(const jolon_Entity *entity, const struct world_mirror *mirror,
                    uint32_t selected)
{
    if (entity->id == selected)
        return CHARACTER_MAP_SELECTED;
    if (entity->state == jolon_ENTITY_WRECK)
        return CHARACTER_MAP_WRECK;
    if (mirror->has_world && entity->kind < mirror->world.kinds._length &&
        mirror->kinds[entity->kind].domain == jolon_DOMAIN_MUNITION)
        return CHARACTER_MAP_MUNITION;
    if (entity->force == jolon_FORCE_BLUE)
        return CHARACTER_MAP_BLUE;
    return entity->force == jolon_FORCE_RED ? CHARACTER_MAP_RED : CHARACTER_MAP_NEUTRAL;
}

static void draw_cell(int row, int column, char cell)
{
    enum curses_text_pair pair = PAIR_PLAIN;
    unsigned attributes = A_DIM;
    if (cell == CHARACTER_MAP_BLUE || cell == CHARACTER_MAP_RED) {
        pair = cell == CHARACTER_MAP_BLUE ? PAIR_BLUE : PAIR_RED;
        attributes = A_BOLD;
    } else if (cell == CHARACTER_MAP_WATER) {
        pair = PAIR_WATER;
    } else if (cell == CHARACTER_MAP_BOTH || cell == CHARACTER_MAP_MUNITION) {
        pair = PAIR_WARN;
        attributes = A_BOLD;
    } else if (cell == CHARACTER_MAP_SELECTED) {
        attributes = A_BOLD | A_REVERSE;
    }
    const char text[2] = {cell, '\0'};
    curses_text_put(row, column, text, attributes, pair);
}

static void draw_map(struct screen *screen, const struct world_mirror *mirror, int top, int rows,
                     int columns)
{
    double side_m = mirror->has_world ? mirror->world.side_m : 1.0;
    struct character_map_ground ground = {mirror->world.height_m, mirror->world.water,
                                          mirror->has_world ? jolon_MAP_SIDE : 0, side_m};
    struct character_map_area area = screen_state_area(&screen->state, mirror, side_m);
    if (screen->state.zoom == 0 && columns > rows * CHARACTER_MAP_COLUMNS_A_ROW)
        columns = rows * CHARACTER_MAP_COLUMNS_A_ROW; /* the whole world is a square */
    character_map_begin(&screen->map, rows, columns, &area, &ground);
    for (uint32_t i = 0; mirror->has_batch && i < mirror->batch.count; i++) {
        const jolon_Entity *entity = &mirror->batch.entity[i];
        character_map_mark(&screen->map, entity->x_m, entity->z_m,
                           mark_of(entity, mirror, screen->state.selected));
    }
    for (int row = 0; row < screen->map.rows; row++) {
        for (int column = 0; column < screen->map.columns; column++)
            draw_cell(top + row, column, screen->map.cell[row][column]);
    }
}

void pages_map(struct screen *screen, const struct world_mirror *mirror, int top, int rows)
{
    char line[STATUS_LINES_MAX];
    if (rows < 2)
        return;
    draw_map(screen, mirror, top, rows - 1, COLS);
    const struct character_map *map = &screen->map;
    int used = snprintf(line, sizeof line, "middle %.0f, %.0f   %.1f km across", screen->state.x,
                        screen->state.z, map->m_per_column * (double)map->columns / 1000.0);
    if (screen->state.selected)
        (void)snprintf(line + used, sizeof line - (size_t)used, "   @ is %u%s",
                       screen->state.selected, screen->state.follow ? ", followed" : "");
    curses_text_put(top + rows - 1, 0, line, A_NORMAL, PAIR_PLAIN);
}

/* --- events ------------------------------------------------------------------------------------*/

static bool event_matches(const char *line, const char *filter)
{
    while (*filter) {
        char word[VEHICLE_TABLE_FILTER_MAX];
        size_t length = strcspn(filter, " ");
        memcpy(word, filter, length);
        word[length] = '\0';
        if (!strcasestr(line, word))
            return false;
        filter += length;
        filter += strspn(filter, " ");
    }
    return true;
}

static const char *event_at(const struct screen *screen, uint64_t back)
{
    return screen->event[(screen->event_count - 1 - back) % SCREEN_EVENTS];
}

/* Draws the events that match, the newest at the bottom, without the `skip` newest ones. Returns
 * how many could be skipped. */
static uint64_t draw_events(const struct screen *screen, const char *filter, uint64_t skip, int top,
                            int rows, int column)
{
    uint64_t kept = screen->event_count < SCREEN_EVENTS ? screen->event_count : SCREEN_EVENTS;
    uint64_t matching = 0, shown = 0;
    const char *line[CHARACTER_MAP_ROWS_MAX];
    uint64_t limit = rows < 0                        ? 0
                     : rows > CHARACTER_MAP_ROWS_MAX ? CHARACTER_MAP_ROWS_MAX
                                                     : (uint64_t)rows;
    for (uint64_t back = 0; back < kept; back++) {
        const char *text = event_at(screen, back);
        if (!event_matches(text, filter))
            continue;
        if (matching++ >= skip && shown < limit)
            line[shown++] = text;
    }
    for (uint64_t i = 0; i < shown; i++)
        curses_text_put(top + (int)i, column, line[shown - 1 - i], A_NORMAL, PAIR_PLAIN);
    return matching > limit ? matching - limit : 0;
}

static void draw_filter(const struct screen *screen, int row, const char *what)
{
    char line[STATUS_LINES_MAX];
    const char *filter = screen->state.filter[screen->state.page];
    if (screen->state.typing || filter[0])
        (void)snprintf(line, sizeof line, "/%s%s   (%s)", filter, screen->state.typing ? "_" : "",
                       what);
    else
        (void)snprintf(line, sizeof line, "%s", what);
    curses_text_put(row, 0, line, screen->state.typing ? A_REVERSE : A_UNDERLINE, PAIR_PLAIN);
}

void pages_events(struct screen *screen, int top, int rows)
{
    char what[STATUS_LINES_MAX];
    struct screen_state *state = &screen->state;
    state->page_rows = rows > 1 ? (uint32_t)rows - 1 : 1;
    uint64_t limit =
        draw_events(screen, state->filter[SCREEN_STATE_EVENTS], state->back, top + 1, rows - 1, 0);
    state->back = state->back < limit ? state->back : limit;
    if (state->back > 0)
        (void)snprintf(what, sizeof what, "events, %llu newer below; End shows them",
                       (unsigned long long)state->back);
    else
        (void)snprintf(what, sizeof what, "events, the newest at the bottom");
    draw_filter(screen, top, what);
}

/* --- vehicles ----------------------------------------------------------------------------------*/

static enum curses_text_pair pair_of(const jolon_Entity *entity)
{
    return entity->force == jolon_FORCE_BLUE  ? PAIR_BLUE
           : entity->force == jolon_FORCE_RED ? PAIR_RED
                                              : PAIR_PLAIN;
}

void pages_vehicles(struct screen *screen, const struct world_mirror *mirror, int top, int rows)
{
    char line[VEHICLE_TABLE_LINE_MAX], what[STATUS_LINES_MAX];
    struct screen_state *state = &screen->state;
    const struct vehicle_table *table = &screen->table;
    if (!vehicle_table_build(&screen->table, mirror, state->filter[SCREEN_STATE_VEHICLES],
                             state->sort, state->descending)) {
        curses_text_put(top, 0, "no memory for the table", A_BOLD, PAIR_WARN);
        return;
    }
    screen_state_table(state, table, mirror, rows > 2 ? (uint32_t)rows - 2 : 1);
    (void)snprintf(what, sizeof what, "%u vehicles, by %s%s", table->count,
                   vehicle_table_column_name(state->sort), state->descending ? ", descending" : "");
    draw_filter(screen, top, what);
    vehicle_table_head(line, state->sort, state->descending);
    curses_text_put(top + 1, 0, line, A_BOLD, PAIR_PLAIN);
    for (uint32_t i = 0; i < state->page_rows && state->first + i < table->count; i++) {
        const jolon_Entity *entity = &mirror->batch.entity[table->row[state->first + i]];
        bool wreck = entity->state == jolon_ENTITY_WRECK;
        vehicle_table_line(line, mirror, entity);
        curses_text_put(top + 2 + (int)i, 0, line,
                        entity->id == state->selected ? A_REVERSE
                        : wreck                       ? A_DIM
                                                      : A_NORMAL,
                        pair_of(entity));
    }
}

/* --- all ---------------------------------------------------------------------------------------*/

static bool needs_attention(const jolon_ProcessStatus *status)
{
    return status->state == jolon_PROCESS_DEAD ||
           (status->state == jolon_PROCESS_READY && status->beat_age_ms > 100.0);
}

/* "frame time ▁▁▂▁█ 0.91 ms, most 4.20 of 16.7". A full bar is the whole time of a frame. */
static void draw_spark(const struct screen *screen, const struct world_mirror *mirror, int row)
{
    static char bars[SPARKLINE_TEXT_MAX];
    char line[STATUS_LINES_MAX];
    double full_ms = mirror->frame.hz > 0.0 ? 1000.0 / mirror->frame.hz : 0.0;
    size_t columns = COLS > 48 ? (size_t)COLS - 48 : 0;
    sparkline_text(bars, &screen->sparkline, columns, full_ms, screen->utf8);
    curses_text_put(row, 0, "frame time", A_NORMAL, PAIR_PLAIN);
    curses_text_put(row, 11, bars, A_NORMAL, PAIR_PLAIN);
    (void)snprintf(line, sizeof line, "%.2f ms, most %.2f of %.1f", mirror->frame.recent.max_ms,
                   sparkline_max(&screen->sparkline, columns), full_ms);
    curses_text_put(row, 12 + (int)columns, line, A_NORMAL, PAIR_PLAIN);
}

void pages_all(struct screen *screen, const struct world_mirror *mirror, int top, int rows)
{
    char line[STATUS_LINES_MAX];
    int row = top;
    status_lines_frame(line, mirror);
    curses_text_put(row++, 0, line, A_NORMAL, PAIR_PLAIN);
    status_lines_counts(line, mirror);
    curses_text_put(row++, 0, line, A_NORMAL, PAIR_PLAIN);
    draw_spark(screen, mirror, row++);
    status_lines_process_head(line);
    curses_text_put(row++, 0, line, A_UNDERLINE, PAIR_PLAIN);
    for (uint32_t i = 0; i < mirror->role_count; i++) {
        bool attention = needs_attention(&mirror->role[i]);
        status_lines_process(line, &mirror->role[i]);
        curses_text_put(row++, 0, line, attention ? A_BOLD : A_NORMAL,
                        attention ? PAIR_WARN : PAIR_PLAIN);
    }
    int left = rows - (row - top);
    int columns = left * CHARACTER_MAP_COLUMNS_A_ROW;
    if (columns > COLS - EVENT_COLUMNS_MIN)
        columns = COLS - EVENT_COLUMNS_MIN;
    if (left > 0 && columns > 0)
        draw_map(screen, mirror, row, left, columns);
    (void)draw_events(screen, "", 0, row, left, columns > 0 ? columns + 1 : 0);
}

void pages_help(int top, int rows)
{
    static const char *const text[] = {
        "1 2 3 4  Tab   overview, vehicles, events, map",
        "q  Esc         quit; Esc first returns to the overview",
        "",
        "vehicles       arrows, PgUp, PgDn, Home, End select; Enter shows it on the map",
        "  s S          sort by the next or previous column, as right and left; r reverses",
        "  /            filter: words that must match, as  red tank  speed>10  rnds<5  12",
        "events         arrows, PgUp, PgDn, Home, End scroll; / searches",
        "map            + - zoom, arrows pan, 0 the whole world, f follows the selected (@)",
        "               b blue  r red  n neutral  % both  * munition  x wreck  ~ water",
        "",
        "frame time     the longest of the last frames; a full bar is the time of a frame,",
        "               ! is longer than that",
        "",
        "The monitor changes nothing: use jolon ctl, jolon drive or jolon console.",
    };
    for (int i = 0; i < (int)(sizeof text / sizeof text[0]) && i < rows; i++)
        curses_text_put(top + i, 0, text[i], A_NORMAL, PAIR_PLAIN);
}
