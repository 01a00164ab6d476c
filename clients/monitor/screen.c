/* Curses, its keys, and the title and footer around the pages. */
#include "clients/monitor/screen.h"

#include "clients/curses_text.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment.h"
#include "clients/monitor/status_lines.h"
#include "clients/monitor/pages.h"
#include "ipc/topics/event_lines.h"

#include <curses.h>
#include <langinfo.h>
#include <locale.h>
#include <stdlib.h>
#include <string.h>

#define KEY_ESCAPE     27
#define ESCAPE_WAIT_MS 25 /* longest pause within the bytes of a key */

int screen_open(struct screen *screen, struct error_text *error)
{
    *screen = (struct screen){0};
    /* NOLINTNEXTLINE(concurrency-mt-unsafe): the program's own threads do not exist yet */
    (void)setlocale(LC_CTYPE, "");
    screen->utf8 = strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
    if (!newterm(NULL, stdout, stdin))
        return error_text_set(error, "TERM=%s: not known to curses; --lines works on any terminal",
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
    vehicle_table_free(&screen->table);
}

bool screen_event(void *context, const char *line)
{
    struct screen *screen = context;
    char *slot = screen->event[screen->event_count++ % SCREEN_EVENTS];
    size_t length = strnlen(line, SCREEN_EVENT_MAX - 1);
    memcpy(slot, line, length);
    slot[length] = '\0';
    if (screen->state.back > 0)
        screen->state.back++; /* the events that are shown stay in place */
    return true;
}

void screen_sample(struct screen *screen, const struct world_mirror *mirror)
{
    if (!mirror->frame_ns || mirror->frame.frame == screen->spark_frame)
        return;
    screen->spark_frame = mirror->frame.frame;
    sparkline_add(&screen->sparkline, mirror->frame.recent.max_ms);
}

static int state_key(int key)
{
    static const struct {
        int curses, state;
    } keys[] = {
        {KEY_UP, SCREEN_STATE_UP},         {KEY_DOWN, SCREEN_STATE_DOWN},
        {KEY_LEFT, SCREEN_STATE_LEFT},     {KEY_RIGHT, SCREEN_STATE_RIGHT},
        {KEY_PPAGE, SCREEN_STATE_PAGE_UP}, {KEY_NPAGE, SCREEN_STATE_PAGE_DOWN},
        {KEY_HOME, SCREEN_STATE_HOME},     {KEY_END, SCREEN_STATE_END},
        {KEY_ENTER, SCREEN_STATE_ENTER},   {'\n', SCREEN_STATE_ENTER},
        {'\r', SCREEN_STATE_ENTER},        {KEY_BACKSPACE, SCREEN_STATE_BACKSPACE},
        {127, SCREEN_STATE_BACKSPACE},     {'\b', SCREEN_STATE_BACKSPACE},
        {KEY_ESCAPE, SCREEN_STATE_ESCAPE}, {'\t', SCREEN_STATE_TAB},
    };
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        if (keys[i].curses == key)
            return keys[i].state;
    }
    return key < SCREEN_STATE_UP ? key : 0;
}

bool screen_keys(struct screen *screen, const struct world_mirror *mirror)
{
    bool any = false;
    double side_m = mirror->has_world ? mirror->world.side_m : 1.0;
    for (int key = getch(); key != ERR; key = getch()) {
        any = true;
        screen_state_select(&screen->state, &screen->table, mirror,
                            screen_state_key(&screen->state, state_key(key), side_m));
    }
    return any;
}

static void draw_title(const struct screen *screen, const struct world_mirror *mirror,
                       uint64_t now_ns)
{
    static const char *const pages[SCREEN_STATE_PAGES] = {"", "vehicles", "events", "map", "help"};
    char line[STATUS_LINES_MAX];
    status_lines_world(line, mirror, now_ns);
    size_t length = strlen(line);
    while (length < (size_t)COLS && length < sizeof line - 1)
        line[length++] = ' ';
    line[length] = '\0';
    curses_text_put(0, 0, line, A_REVERSE, PAIR_PLAIN);
    const char *page = pages[screen->state.page];
    curses_text_put(0, COLS - (int)strlen(page) - 1, page, A_REVERSE | A_BOLD, PAIR_PLAIN);
}

static const char *key_hint(const struct screen_state *state)
{
    static const char *const keys[SCREEN_STATE_PAGES] = {
        "1 all  2 vehicles  3 events  4 map  ? help  q quit   b blue r red n neutral % both",
        "up/down select  s sort  r reverse  / filter  Enter map  1-4 pages  ? help  q quit",
        "up/down PgUp PgDn  / search  1-4 pages  ? help  q quit",
        "+ - zoom  arrows pan  0 whole  f follow  1-4 pages  ? help  q quit",
        "? back  q quit",
    };
    return state->typing ? "Enter keeps the filter, Esc drops it" : keys[state->page];
}

void screen_draw(struct screen *screen, const struct world_mirror *mirror, uint64_t now_ns)
{
    char notice[STATUS_LINES_MAX];
    const int top = 1, rows = LINES - 2;
    if (!screen->begun && mirror->has_world) {
        screen_state_begin(&screen->state, mirror->world.side_m);
        screen->begun = true;
    }
    (void)erase();
    draw_title(screen, mirror, now_ns);
    switch (screen->state.page) {
    case SCREEN_STATE_VEHICLES:
        pages_vehicles(screen, mirror, top, rows);
        break;
    case SCREEN_STATE_EVENTS:
        pages_events(screen, top, rows);
        break;
    case SCREEN_STATE_MAP:
        pages_map(screen, mirror, top, rows);
        break;
    case SCREEN_STATE_HELP:
        pages_help(top, rows);
        break;
    default:
        pages_all(screen, mirror, top, rows);
        break;
    }
    event_lines_silence(notice, sizeof notice, mirror, now_ns);
    if (notice[0])
        curses_text_put(LINES - 1, 0, notice, A_BOLD, PAIR_WARN);
    else
        curses_text_put(LINES - 1, 0, key_hint(&screen->state), A_DIM, PAIR_PLAIN);
    (void)refresh();
}
