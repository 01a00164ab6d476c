/* Draws the title, the statistics beside the map, the events, other drivers, a notice and the keys.
 */
#include "clients/drive/screen.h"

#include "clients/curses_text.h"
#include "clients/drive/character_map.h"
#include "clients/drive/terminal_keys.h"
#include "clients/drive/status_panel.h"
#include "clients/drive/terminal.h"
#include "ipc/process/process.h"
#include "ipc/process/clock.h"
#include "ipc/topics/event_lines.h"

#include <curses.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#define ROWS_MIN       20
#define COLUMNS_MIN    60
#define NOTICE_NS      (8 * (uint64_t)NS_PER_S)
#define FOOT_ROWS      4 /* look, others, notice, keys */
#define EVENT_ROWS_MIN 3

int screen_open(struct error_text *error)
{
    if (!newterm(NULL, stdout, stdin))
        return error_text_set(error, "TERM=%s: not known to curses; --plain works on any terminal",
                              getenv("TERM") ? getenv("TERM") : "");
    (void)curs_set(0);
    if (process_colours() && has_colors() && start_color() == OK) {
        /* Blue and yellow, which colour-blind people tell apart. The map's letters show the force
         * as well. */
        (void)use_default_colors();
        (void)init_pair(PAIR_BLUE, COLOR_CYAN, -1);
        (void)init_pair(PAIR_RED, COLOR_YELLOW, -1);
        (void)init_pair(PAIR_WATER, COLOR_BLUE, -1);
        (void)init_pair(PAIR_WARN, COLOR_YELLOW, -1);
    }
    return 0;
}

void screen_close(void)
{
    (void)endwin();
}

static void put_bar(int row, const char *text)
{
    char line[STATUS_PANEL_LINE];
    size_t length = strnlen(text, sizeof line - 1);
    memcpy(line, text, length);
    while (length < (size_t)COLS && length < sizeof line - 1)
        line[length++] = ' ';
    line[length] = '\0';
    curses_text_put(row, 0, line, A_REVERSE, PAIR_PLAIN);
}

static void draw_cell(int row, int column, const struct character_map_cell *cell)
{
    static const struct {
        attr_t attributes;
        enum curses_text_pair pair;
    } looks[] = {
        [CHARACTER_MAP_GROUND] = {A_DIM, PAIR_PLAIN},
        [CHARACTER_MAP_WATER] = {A_NORMAL, PAIR_WATER},
        [CHARACTER_MAP_WRECK] = {A_DIM, PAIR_PLAIN},
        [CHARACTER_MAP_NEUTRAL] = {A_NORMAL, PAIR_PLAIN},
        [CHARACTER_MAP_RED] = {A_BOLD, PAIR_RED},
        [CHARACTER_MAP_BLUE] = {A_BOLD, PAIR_BLUE},
        [CHARACTER_MAP_MUNITION] = {A_BOLD, PAIR_PLAIN},
        [CHARACTER_MAP_TARGET] = {A_REVERSE, PAIR_RED},
        [CHARACTER_MAP_SELF] = {A_REVERSE, PAIR_PLAIN},
    };
    curses_text_put(row, column, cell->text, looks[cell->mark].attributes, looks[cell->mark].pair);
}

static void draw_map(const struct session *session, int top, int rows, int left)
{
    static struct character_map map;
    char scale[64];
    character_map_draw(&map, session->mirror, session_entity(session), session->target, rows - 1,
                       (COLS - left) / 2, character_map_cell_m(session->zoom));
    for (int row = 0; row < map.rows; row++) {
        for (int column = 0; column < map.columns; column++)
            draw_cell(top + row, left + 2 * column, &map.cell[row][column]);
    }
    (void)snprintf(scale, sizeof scale, "a cell %g m; blue RED Neutral xx wreck", map.cell_m);
    curses_text_put(top + rows - 1, left, scale, A_DIM, PAIR_PLAIN);
}

static void draw_statistics(const struct session *session, int top, int rows)
{
    char row[STATUS_PANEL_ROWS][STATUS_PANEL_COLUMNS];
    int at = top;
    status_panel_statistics(row, session);
    for (int i = 0; i < STATUS_PANEL_ROWS && at < top + rows; i++) {
        if (row[i][0])
            curses_text_put(at++, 0, row[i], A_NORMAL, PAIR_PLAIN);
    }
}

static void draw_events(const struct recent_events *events, int top, int rows)
{
    uint64_t kept = events->count < RECENT_EVENTS_KEPT ? events->count : RECENT_EVENTS_KEPT;
    uint64_t shown = kept < (uint64_t)rows ? kept : (uint64_t)rows;
    for (uint64_t i = 0; i < shown; i++)
        curses_text_put(top + (int)i, 0,
                        events->line[(events->count - shown + i) % RECENT_EVENTS_KEPT], A_NORMAL,
                        PAIR_PLAIN);
}

/* Writes text in two rows, broken between words. */
static void put_two_rows(int row, int column, const char *text, attr_t attributes)
{
    char first[STATUS_PANEL_LINE];
    size_t width = COLS > column ? (size_t)(COLS - column) : 1, end = strlen(text);
    if (end > width)
        for (end = width; end > 0 && text[end] != ' '; end--)
            continue;
    snprintf(first, sizeof first, "%.*s", (int)end, text);
    curses_text_put(row, column, first, attributes, PAIR_PLAIN);
    if (text[end] == ' ')
        curses_text_put(row + 1, column, text + end + 1, attributes, PAIR_PLAIN);
}

static void draw_help(const char *inputs)
{
    const char *keys, *meaning;
    put_two_rows(2, 2, inputs, A_DIM);
    for (uint32_t i = 0; terminal_keys_help(i, &keys, &meaning); i++) {
        curses_text_put(5 + (int)i, 2, keys, A_BOLD, PAIR_PLAIN);
        curses_text_put(5 + (int)i, 14, meaning, A_NORMAL, PAIR_PLAIN);
    }
}

/* Draws the other drivers, and below them a warning or the notice. A long notice takes both rows.
 */
static void draw_notice(const struct session *session, uint64_t now_ns)
{
    char warning[STATUS_PANEL_LINE], others[STATUS_PANEL_LINE];
    bool noticed = session->notices &&
                   (now_ns - session->notice_ns < NOTICE_NS || session->state != SESSION_DRIVING);
    event_lines_silence(warning, sizeof warning, session->mirror, now_ns);
    if (!warning[0] && noticed && strlen(session->notice) > (size_t)COLS) {
        put_two_rows(LINES - 3, 0, session->notice, A_BOLD);
        return;
    }
    status_panel_others(others, session);
    curses_text_put(LINES - 3, 0, others, A_DIM, PAIR_PLAIN);
    if (warning[0])
        curses_text_put(LINES - 2, 0, warning, A_BOLD, PAIR_WARN);
    else if (noticed)
        curses_text_put(LINES - 2, 0, session->notice, A_BOLD, PAIR_PLAIN);
}

static void draw_foot(const struct session *session, uint64_t now_ns)
{
    char line[STATUS_PANEL_LINE];
    status_panel_look(line, session);
    curses_text_put(LINES - 4, 0, line, A_NORMAL, PAIR_PLAIN);
    draw_notice(session, now_ns);
    curses_text_put(
        LINES - 1, 0,
        "w s throttle  a d steer  b brake  arrows aim  t lock  space fire  h help  q quit", A_DIM,
        PAIR_PLAIN);
}

static void update_size(void)
{
    struct winsize size;
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 && size.ws_col > 0)
        (void)resizeterm(size.ws_row, size.ws_col);
}

void screen_draw(const struct session *session, const struct recent_events *events,
                 const char *inputs, uint64_t now_ns)
{
    char line[STATUS_PANEL_LINE];
    if (terminal_resized())
        update_size();
    (void)erase();
    status_panel_head(line, session, now_ns);
    put_bar(0, line);
    int rows = LINES - 1 - FOOT_ROWS - EVENT_ROWS_MIN;
    if (rows > STATUS_PANEL_ROWS && LINES < 40)
        rows = STATUS_PANEL_ROWS;
    if (LINES < ROWS_MIN || COLS < COLUMNS_MIN) {
        curses_text_put(1, 0, "this terminal is small: 60 x 20 is the least, 80 x 24 is good",
                        A_NORMAL, PAIR_PLAIN);
        draw_foot(session, now_ns);
    } else if (session->help) {
        draw_help(inputs);
    } else {
        draw_statistics(session, 1, rows);
        draw_map(session, 1, rows, STATUS_PANEL_COLUMNS + 1);
        draw_events(events, 1 + rows, LINES - 1 - FOOT_ROWS - rows);
        draw_foot(session, now_ns);
    }
    (void)refresh();
}
