/* jolon-monitor: shows a world as a screen in a terminal, as a status line a second, as a JSON
 * object, or as its events. It may start at any time, on any machine. Any number of monitors may
 * run, and the world waits for none. */
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "clients/monitor/status_json.h"
#include "clients/monitor/status_lines.h"
#include "clients/monitor/options.h"
#include "clients/monitor/plain_output.h"
#include "clients/monitor/screen.h"
#include "ipc/topics/event_json.h"
#include "ipc/topics/event_lines.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

/* How often the screen reads keys and new events. */
#define POLL_NS (50 * (uint64_t)NS_PER_MS)

#define NICENESS 10 /* a hundred monitors must not make a frame late */

static int run_events(struct event_merge *merge)
{
    while (!process_stopping()) {
        bool good = event_merge_poll(merge, plain_output_line, NULL);
        if (!good || !plain_output_flush())
            return EXIT_REFUSED; /* the reader has gone, or there is no memory */
        dds_topics_wait(merge->waitset, merge->count ? POLL_NS : NS_PER_S / 4);
    }
    if (merge->missed)
        log_warn("events were missed at %llu places", (unsigned long long)merge->missed);
    return EXIT_OK;
}

static int run_screen(struct world_mirror *mirror, struct event_merge *merge,
                      const struct options *options)
{
    static struct screen screen;
    struct error_text error;
    uint64_t due_ns = 0;
    if (screen_open(&screen, &error) != 0)
        die_refused("%s", error.text);
    while (!process_stopping() && !screen.state.quit) {
        world_mirror_take(mirror);
        screen_sample(&screen, mirror);
        (void)event_merge_poll(merge, screen_event, &screen);
        uint64_t now_ns = clock_now_ns();
        if (screen_keys(&screen, mirror) || now_ns >= due_ns) {
            screen_draw(&screen, mirror, now_ns);
            due_ns = now_ns + (uint64_t)(NS_PER_S / options->rate_hz);
        }
        clock_sleep_until_ns(now_ns + POLL_NS < due_ns ? now_ns + POLL_NS : due_ns);
    }
    screen_close(&screen);
    return EXIT_OK;
}

int main(int argc, char **argv)
{
    static struct world_mirror mirror;
    static struct event_merge merge;
    struct options options;
    struct dds_link link;
    struct error_text error;
    int code;
    log_open("monitor");
    options_parse(&options, argc, argv);
    bool screen = !options.once && !options.lines && !options.json && !options.events &&
                  isatty(STDOUT_FILENO);
    options.link.quiet = screen;
    options.link.part = DDS_OBSERVER;
    if (options.rate_hz <= 0.0)
        options.rate_hz = screen ? OPTIONS_SCREEN_HZ : OPTIONS_LINES_HZ;
    process_signals();
    if (process_lower_priority(NICENESS) != 0) /* before DDS starts its threads */
        log_warn("cannot lower its priority: %s", strerror(errno));
    if (dds_link_open(&link, &options.link, options.world, &error) != 0 ||
        (!options.events &&
         world_mirror_open(&mirror, &link, options.world,
                           screen || options.json ? WORLD_MIRROR_MOTIONS : WORLD_MIRROR_NOTHING,
                           &error) != 0) ||
        ((options.events || screen) &&
         event_merge_open(&merge, &link, screen ? event_lines_event : event_json, &error) != 0))
        die_refused("%s", error.text);
    if (options.events)
        code = run_events(&merge);
    else if (options.once)
        code = plain_output_once(&mirror, &options);
    else if (screen)
        code = run_screen(&mirror, &merge, &options);
    else
        code = plain_output_lines(&mirror, &options);
    event_merge_close(&merge);
    world_mirror_close(&mirror);
    dds_link_close(&link, code);
    return code;
}
