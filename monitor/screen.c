/* The terminal view: what the world says above, the map and the latest events below. */
#include "monitor/screen.h"

#include "ipc/segment.h"
#include "monitor/lines.h"

#include <curses.h>
#include <stdlib.h>
#include <string.h>

enum pair { PAIR_PLAIN, PAIR_BLUE, PAIR_RED, PAIR_WATER, PAIR_WARN };

#define KEY_ESCAPE 27

/* The map is as wide as it is high: a character is about twice as high as wide. */
#define COLUMNS_A_ROW 2

/* Columns that the events keep. */
#define EVENT_COLUMNS_MIN 40

int screen_open(struct screen *screen, struct reason *reason)
{
    *screen = (struct screen){0};
    if (!newterm(NULL, stdout, stdin))
        return reason_set(reason, "TERM=%s: no terminal that curses knows; --lines works on any",
                          getenv("TERM") ? getenv("TERM") : "");
    (void)cbreak();
    (void)noecho();
    (void)nodelay(stdscr, TRUE);
    (void)keypad(stdscr, TRUE);
    (void)curs_set(0);
    if (has_colors() && start_color() == OK) {
        (void)use_default_colors();
        (void)init_pair(PAIR_BLUE, COLOR_BLUE, -1);
        (void)init_pair(PAIR_RED, COLOR_RED, -1);
        (void)init_pair(PAIR_WATER, COLOR_CYAN, -1);
        (void)init_pair(PAIR_WARN, COLOR_YELLOW, -1);
    }
    return 0;
}

void screen_close(void)
{
    (void)endwin();
}

bool screen_event(void *context, const char *line)
{
    struct screen *screen = context;
    char *slot = screen->event[screen->event_count++ % SCREEN_EVENTS];
    size_t length = strnlen(line, SCREEN_EVENT_MAX - 1);
    memcpy(slot, line, length);
    slot[length] = '\0';
    return true;
}

bool screen_quit(void)
{
    bool quit = false;
    for (int key = getch(); key != ERR; key = getch())
        quit = quit || key == 'q' || key == 'Q' || key == KEY_ESCAPE;
    return quit;
}

/* One row's text from column on, cut at the edge. */
static void put(int row, int column, const char *text, attr_t attributes, enum pair pair)
{
    if (row < 0 || row >= LINES || column >= COLS)
        return;
    (void)attr_set(attributes, (short)pair, NULL);
    (void)mvaddnstr(row, column, text, COLS - column);
    (void)attr_set(A_NORMAL, PAIR_PLAIN, NULL);
}

static bool wants_care(const jolon_ProcessStatus *status)
{
    return status->state == jolon_PROCESS_DEAD ||
           (status->state == jolon_PROCESS_READY && status->beat_age_ms > 100.0);
}

static char mark_of(const jolon_Entity *entity, const struct mirror *mirror)
{
    if (entity->state == jolon_ENTITY_WRECK)
        return MAP_WRECK;
    if (mirror->has_world && entity->kind < mirror->world.kinds._length &&
        mirror->kinds[entity->kind].domain == jolon_DOMAIN_MUNITION)
        return MAP_MUNITION;
    if (entity->force == jolon_FORCE_BLUE)
        return MAP_BLUE;
    return entity->force == jolon_FORCE_RED ? MAP_RED : MAP_NEUTRAL;
}

static void draw_cell(int row, int column, char cell)
{
    enum pair pair = PAIR_PLAIN;
    attr_t attributes = A_DIM;
    if (cell == MAP_BLUE || cell == MAP_RED) {
        pair = cell == MAP_BLUE ? PAIR_BLUE : PAIR_RED;
        attributes = A_BOLD;
    } else if (cell == MAP_WATER) {
        pair = PAIR_WATER;
    } else if (cell == MAP_BOTH || cell == MAP_MUNITION) {
        pair = PAIR_WARN;
        attributes = A_BOLD;
    }
    const char text[2] = {cell, '\0'};
    put(row, column, text, attributes, pair);
}

static void draw_map(struct screen *screen, const struct mirror *mirror, int top, int rows,
                     int columns)
{
    struct map *map = &screen->map;
    double side_m = mirror->world.side_m;
    map_ground(map, rows, columns, mirror->world.height_m, mirror->world.water,
               mirror->has_world ? jolon_MAP_SIDE : 0);
    for (uint32_t i = 0; mirror->has_batch && i < mirror->batch.count; i++) {
        const jolon_Entity *entity = &mirror->batch.entity[i];
        map_mark(map, entity->x_m, entity->z_m, side_m, mark_of(entity, mirror));
    }
    for (int row = 0; row < map->rows; row++) {
        for (int column = 0; column < map->columns; column++)
            draw_cell(top + row, column, map->cell[row][column]);
    }
}

/* The latest at the bottom. */
static void draw_events(const struct screen *screen, int top, int rows, int column)
{
    uint64_t kept = screen->event_count < SCREEN_EVENTS ? screen->event_count : SCREEN_EVENTS;
    if (rows < 0)
        return;
    uint64_t shown = kept < (uint64_t)rows ? kept : (uint64_t)rows;
    for (uint64_t i = 0; i < shown; i++)
        put(top + (int)i, column, screen->event[(screen->event_count - shown + i) % SCREEN_EVENTS],
            A_NORMAL, PAIR_PLAIN);
}

/* The part above the map; how many rows it took. */
static int draw_status(const struct mirror *mirror, uint64_t now_ns)
{
    char line[LINES_MAX];
    int row = 0;
    lines_world(line, mirror, now_ns);
    size_t length = strlen(line);
    while (length < (size_t)COLS && length < sizeof line - 1)
        line[length++] = ' ';
    line[length] = '\0';
    put(row++, 0, line, A_REVERSE, PAIR_PLAIN);
    lines_frame(line, mirror);
    put(row++, 0, line, A_NORMAL, PAIR_PLAIN);
    lines_counts(line, mirror);
    put(row++, 0, line, A_NORMAL, PAIR_PLAIN);
    lines_process_head(line);
    put(row++, 0, line, A_UNDERLINE, PAIR_PLAIN);
    for (uint32_t i = 0; i < mirror->role_count; i++) {
        bool care = wants_care(&mirror->role[i]);
        lines_process(line, &mirror->role[i]);
        put(row++, 0, line, care ? A_BOLD : A_NORMAL, care ? PAIR_WARN : PAIR_PLAIN);
    }
    return row;
}

void screen_draw(struct screen *screen, const struct mirror *mirror, uint64_t now_ns)
{
    char notice[LINES_MAX];
    (void)erase();
    int top = draw_status(mirror, now_ns);
    int rows = LINES - top - 1;
    int columns = rows * COLUMNS_A_ROW;
    if (columns > COLS - EVENT_COLUMNS_MIN)
        columns = COLS - EVENT_COLUMNS_MIN;
    if (rows > 0 && columns > 0)
        draw_map(screen, mirror, top, rows, columns);
    draw_events(screen, top, rows, columns > 0 ? columns + 1 : 0);
    lines_notice(notice, mirror, now_ns);
    if (notice[0])
        put(LINES - 1, 0, notice, A_BOLD, PAIR_WARN);
    else
        put(LINES - 1, 0, "q quits   b blue  r red  n neutral  % both  * munition  x wreck", A_DIM,
            PAIR_PLAIN);
    (void)refresh();
}
