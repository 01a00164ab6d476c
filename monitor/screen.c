/* The terminal: curses, its keys, and the frame around the pages. */
#include "monitor/screen.h"

#include "ipc/process.h"
#include "ipc/segment.h"
#include "monitor/lines.h"
#include "monitor/pages.h"
#include "topics/tell.h"

#include <curses.h>
#include <langinfo.h>
#include <locale.h>
#include <stdlib.h>
#include <string.h>

#define KEY_ESCAPE     27
#define ESCAPE_WAIT_MS 25 /* that what follows an escape may take, for a key of several bytes */

int screen_open(struct screen *screen, struct reason *reason)
{
    *screen = (struct screen){0};
    (void)setlocale(LC_CTYPE,
                    ""); /* NOLINT(concurrency-mt-unsafe): before there are threads of ours */
    screen->utf8 = strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
    if (!newterm(NULL, stdout, stdin))
        return reason_set(reason, "TERM=%s: no terminal that curses knows; --lines works on any",
                          getenv("TERM") ? getenv("TERM") : "");
    (void)set_escdelay(ESCAPE_WAIT_MS);
    (void)cbreak();
    (void)noecho();
    (void)nodelay(stdscr, TRUE);
    (void)keypad(stdscr, TRUE);
    (void)curs_set(0);
    if (process_colours() && has_colors() && start_color() == OK) {
        (void)use_default_colors();
        (void)init_pair(PAIR_BLUE, COLOR_BLUE, -1);
        (void)init_pair(PAIR_RED, COLOR_RED, -1);
        (void)init_pair(PAIR_WATER, COLOR_CYAN, -1);
        (void)init_pair(PAIR_WARN, COLOR_YELLOW, -1);
    }
    return 0;
}

void screen_close(struct screen *screen)
{
    (void)endwin();
    table_free(&screen->table);
}

bool screen_event(void *context, const char *line)
{
    struct screen *screen = context;
    char *slot = screen->event[screen->event_count++ % SCREEN_EVENTS];
    size_t length = strnlen(line, SCREEN_EVENT_MAX - 1);
    memcpy(slot, line, length);
    slot[length] = '\0';
    if (screen->desk.back > 0)
        screen->desk.back++; /* what somebody reads stays where it is */
    return true;
}

void screen_note(struct screen *screen, const struct mirror *mirror)
{
    if (!mirror->frame_ns || mirror->frame.frame == screen->spark_frame)
        return;
    screen->spark_frame = mirror->frame.frame;
    spark_add(&screen->spark, mirror->frame.recent.max_ms);
}

static int key_of(int key)
{
    static const struct {
        int curses, desk;
    } keys[] = {
        {KEY_UP, DESK_UP},       {KEY_DOWN, DESK_DOWN},     {KEY_LEFT, DESK_LEFT},
        {KEY_RIGHT, DESK_RIGHT}, {KEY_PPAGE, DESK_PAGE_UP}, {KEY_NPAGE, DESK_PAGE_DOWN},
        {KEY_HOME, DESK_HOME},   {KEY_END, DESK_END},       {KEY_ENTER, DESK_ENTER},
        {'\n', DESK_ENTER},      {'\r', DESK_ENTER},        {KEY_BACKSPACE, DESK_BACKSPACE},
        {127, DESK_BACKSPACE},   {'\b', DESK_BACKSPACE},    {KEY_ESCAPE, DESK_ESCAPE},
        {'\t', DESK_TAB},
    };
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        if (keys[i].curses == key)
            return keys[i].desk;
    }
    return key < DESK_UP ? key : 0;
}

bool screen_keys(struct screen *screen, const struct mirror *mirror)
{
    bool any = false;
    double side_m = mirror->has_world ? mirror->world.side_m : 1.0;
    for (int key = getch(); key != ERR; key = getch()) {
        any = true;
        desk_choose(&screen->desk, &screen->table, mirror,
                    desk_key(&screen->desk, key_of(key), side_m));
    }
    return any;
}

static void draw_title(const struct screen *screen, const struct mirror *mirror, uint64_t now_ns)
{
    static const char *const pages[DESK_PAGES] = {"", "vehicles", "events", "map", "help"};
    char line[LINES_MAX];
    lines_world(line, mirror, now_ns);
    size_t length = strlen(line);
    while (length < (size_t)COLS && length < sizeof line - 1)
        line[length++] = ' ';
    line[length] = '\0';
    pages_put(0, 0, line, A_REVERSE, PAIR_PLAIN);
    const char *page = pages[screen->desk.page];
    pages_put(0, COLS - (int)strlen(page) - 1, page, A_REVERSE | A_BOLD, PAIR_PLAIN);
}

static const char *keys_of(const struct desk *desk)
{
    static const char *const keys[DESK_PAGES] = {
        "1 all  2 vehicles  3 events  4 map  ? help  q quit   b blue r red n neutral % both",
        "up/down choose  s sort  r turn  / filter  Enter map  1-4 pages  ? help  q quit",
        "up/down PgUp PgDn  / search  1-4 pages  ? help  q quit",
        "+ - zoom  arrows pan  0 whole  f follow  1-4 pages  ? help  q quit",
        "? back  q quit",
    };
    return desk->typing ? "Enter keeps the filter, Esc drops it" : keys[desk->page];
}

void screen_draw(struct screen *screen, const struct mirror *mirror, uint64_t now_ns)
{
    char notice[LINES_MAX];
    const int top = 1, rows = LINES - 2;
    if (!screen->begun && mirror->has_world) {
        desk_begin(&screen->desk, mirror->world.side_m);
        screen->begun = true;
    }
    (void)erase();
    draw_title(screen, mirror, now_ns);
    switch (screen->desk.page) {
    case DESK_VEHICLES:
        pages_vehicles(screen, mirror, top, rows);
        break;
    case DESK_EVENTS:
        pages_events(screen, top, rows);
        break;
    case DESK_MAP:
        pages_map(screen, mirror, top, rows);
        break;
    case DESK_HELP:
        pages_help(top, rows);
        break;
    default:
        pages_all(screen, mirror, top, rows);
        break;
    }
    tell_silence(notice, sizeof notice, mirror, now_ns);
    if (notice[0])
        pages_put(LINES - 1, 0, notice, A_BOLD, PAIR_WARN);
    else
        pages_put(LINES - 1, 0, keys_of(&screen->desk), A_DIM, PAIR_PLAIN);
    (void)refresh();
}
