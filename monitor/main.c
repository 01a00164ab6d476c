/* jolon-monitor: attaches to a world at any time, from anywhere, and shows what it does: a terminal
 * view, one status line a second, one JSON object, or the events. Any number of them may run; none
 * is ever waited for. */
#include "ipc/clock.h"
#include "ipc/log.h"
#include "ipc/process.h"
#include "monitor/json.h"
#include "monitor/lines.h"
#include "monitor/options.h"
#include "monitor/screen.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <unistd.h>

#define ONCE_LIMIT_NS (3 * (uint64_t)NS_PER_S)

/* How often the line mode says that it still waits. */
#define NOTICE_NS (10 * (uint64_t)NS_PER_S)

/* What a world that is there takes at most to be heard. */
#define FIRST_NS (500 * (uint64_t)NS_PER_MS)

/* How often the screen looks at the keyboard and at new events. */
#define LOOK_NS (50 * (uint64_t)NS_PER_MS)

static bool flush_output(void)
{
    return fflush(stdout) == 0 && !ferror(stdout);
}

static bool print_line(void *unused, const char *line)
{
    (void)unused;
    return puts(line) >= 0;
}

static bool print_json(const struct picture *picture, uint64_t now_ns)
{
    char *text = json_status(picture, now_ns);
    bool good = text && puts(text) >= 0;
    cJSON_free(text);
    return good && flush_output();
}

static void print_text(const struct picture *picture, uint64_t now_ns)
{
    char line[LINES_MAX];
    lines_world(line, picture, now_ns);
    (void)puts(line);
    lines_frame(line, picture);
    (void)puts(line);
    lines_counts(line, picture);
    (void)puts(line);
    lines_process_head(line);
    (void)puts(line);
    for (uint32_t i = 0; i < picture->role_count; i++) {
        lines_process(line, &picture->role[i]);
        (void)puts(line);
    }
}

/* One look at the world. An exit code. */
static int run_once(struct picture *picture, const struct options *options)
{
    uint64_t limit_ns = clock_now_ns() + ONCE_LIMIT_NS;
    uint64_t now_ns = clock_now_ns();
    for (; !picture_whole(picture) && now_ns < limit_ns; now_ns = clock_now_ns()) {
        if (process_stopping())
            return EXIT_REFUSED;
        picture_wait(picture, limit_ns);
        picture_take(picture);
    }
    if (!picture_whole(picture)) {
        (void)fprintf(stderr,
                      "jolon-monitor: world '%s': %s within 3 s; is it running, with its "
                      "reporter? `jolon worlds` lists those there are\n",
                      options->world,
                      picture->frame_ns ? "only part of its status came" : "no status came");
        return EXIT_REFUSED;
    }
    if (options->json)
        return print_json(picture, now_ns) ? EXIT_OK : EXIT_REFUSED;
    print_text(picture, now_ns);
    return flush_output() ? EXIT_OK : EXIT_REFUSED;
}

/* A line each time it is due; while there is no world, one when it goes and then seldom. */
static int run_lines(struct picture *picture, const struct options *options)
{
    char line[LINES_MAX];
    uint64_t due_ns = clock_now_ns() + FIRST_NS;
    uint64_t notice_ns = 0;
    while (!process_stopping()) {
        picture_wait(picture, due_ns);
        picture_take(picture);
        uint64_t now_ns = clock_now_ns();
        if (now_ns < due_ns)
            continue;
        due_ns = now_ns + (uint64_t)(NS_PER_S / options->rate_hz);
        bool live = picture_live(picture, now_ns);
        if (!live && now_ns < notice_ns)
            continue;
        notice_ns = live ? 0 : now_ns + NOTICE_NS;
        lines_status(line, picture, now_ns);
        if (options->json ? !print_json(picture, now_ns) : puts(line) < 0 || !flush_output())
            return EXIT_REFUSED; /* nobody reads any more */
    }
    return EXIT_OK;
}

static int run_events(struct tail *tail)
{
    while (!process_stopping()) {
        bool good = tail_turn(tail, print_line, NULL);
        if (!good || !flush_output())
            return EXIT_REFUSED; /* nobody reads any more, or no memory */
        dds_topics_wait(tail->waitset, tail->count ? LOOK_NS : NS_PER_S / 4);
    }
    if (tail->missed)
        log_warn("events were missed at %llu places", (unsigned long long)tail->missed);
    return EXIT_OK;
}

static int run_screen(struct picture *picture, struct tail *tail, const struct options *options)
{
    static struct screen screen;
    struct reason reason;
    uint64_t due_ns = 0;
    if (screen_open(&screen, &reason) != 0)
        die_refused("%s", reason.text);
    while (!process_stopping() && !screen_quit()) {
        picture_take(picture);
        (void)tail_turn(tail, screen_event, &screen);
        uint64_t now_ns = clock_now_ns();
        if (now_ns >= due_ns) {
            screen_draw(&screen, picture, now_ns);
            due_ns = now_ns + (uint64_t)(NS_PER_S / options->rate_hz);
        }
        clock_sleep_until_ns(now_ns + LOOK_NS < due_ns ? now_ns + LOOK_NS : due_ns);
    }
    screen_close();
    return EXIT_OK;
}

int main(int argc, char **argv)
{
    static struct picture picture;
    static struct tail tail;
    struct options options;
    struct dds_link link;
    struct reason reason;
    int code;
    log_open("monitor");
    options_parse(&options, argc, argv);
    bool screen = !options.once && !options.lines && !options.json && !options.events &&
                  isatty(STDOUT_FILENO);
    options.link.quiet = screen;
    if (options.rate_hz <= 0.0)
        options.rate_hz = screen ? OPTIONS_SCREEN_HZ : OPTIONS_LINES_HZ;
    process_signals();
    if (dds_link_open(&link, &options.link, options.world, &reason) != 0 ||
        (!options.events && picture_open(&picture, &link, options.world, &reason) != 0) ||
        ((options.events || screen) &&
         tail_open(&tail, &link, screen ? lines_event : json_event, &reason) != 0))
        die_refused("%s", reason.text);
    if (options.events)
        code = run_events(&tail);
    else if (options.once)
        code = run_once(&picture, &options);
    else if (screen)
        code = run_screen(&picture, &tail, &options);
    else
        code = run_lines(&picture, &options);
    tail_close(&tail);
    picture_close(&picture);
    dds_link_close(&link, code);
    return code;
}
