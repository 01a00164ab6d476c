/* The monitor without a screen. */
#include "clients/monitor/plain_output.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "clients/monitor/status_json.h"
#include "clients/monitor/status_lines.h"

#include <cjson/cJSON.h>
#include <stdio.h>

#define ONCE_LIMIT_NS (3 * (uint64_t)NS_PER_S)

/* How often the line mode reports that it still waits. */
#define NOTICE_NS (10 * (uint64_t)NS_PER_S)

/* The longest time until the data of a present world has come. */
#define FIRST_NS (500 * (uint64_t)NS_PER_MS)

/* The longest time between two checks for a request to stop. */
#define SLEEP_MAX_NS (250 * (uint64_t)NS_PER_MS)

bool plain_output_flush(void)
{
    return fflush(stdout) == 0 && !ferror(stdout);
}

bool plain_output_line(void *unused, const char *line)
{
    (void)unused;
    return puts(line) >= 0;
}

static bool print_json(const struct world_mirror *mirror, const struct options *options,
                       uint64_t now_ns)
{
    char *text = status_json(mirror, options->filter, now_ns);
    bool good = text && puts(text) >= 0;
    cJSON_free(text);
    return good && plain_output_flush();
}

static void print_text(const struct world_mirror *mirror, uint64_t now_ns)
{
    char line[STATUS_LINES_MAX];
    status_lines_world(line, mirror, now_ns);
    (void)puts(line);
    status_lines_frame(line, mirror);
    (void)puts(line);
    status_lines_counts(line, mirror);
    (void)puts(line);
    status_lines_process_head(line);
    (void)puts(line);
    for (uint32_t i = 0; i < mirror->role_count; i++) {
        status_lines_process(line, &mirror->role[i]);
        (void)puts(line);
    }
}

int plain_output_once(struct world_mirror *mirror, const struct options *options)
{
    uint64_t limit_ns = clock_now_ns() + ONCE_LIMIT_NS;
    uint64_t now_ns = clock_now_ns();
    for (; !world_mirror_whole(mirror) && now_ns < limit_ns; now_ns = clock_now_ns()) {
        if (process_stopping())
            return EXIT_REFUSED;
        world_mirror_wait(mirror, limit_ns);
        world_mirror_take(mirror);
    }
    if (!world_mirror_whole(mirror)) {
        (void)fprintf(stderr,
                      "jolon-monitor: world '%s': %s within 3 s; is it running, with its "
                      "reporter? `jolon worlds` lists the worlds\n",
                      options->world,
                      mirror->frame_ns ? "only part of its status came" : "no status came");
        return EXIT_REFUSED;
    }
    if (options->json)
        return print_json(mirror, options, now_ns) ? EXIT_OK : EXIT_REFUSED;
    print_text(mirror, now_ns);
    return plain_output_flush() ? EXIT_OK : EXIT_REFUSED;
}

/* Prints a line each time one is due. While there is no world it prints one at once and then one
 * every NOTICE_NS. It wakes for the lines alone; DDS keeps the newest sample of each topic
 * meanwhile. */
int plain_output_lines(struct world_mirror *mirror, const struct options *options)
{
    char line[STATUS_LINES_MAX];
    uint64_t due_ns = clock_now_ns() + FIRST_NS;
    uint64_t notice_ns = 0;
    while (!process_stopping()) {
        uint64_t now_ns = clock_now_ns();
        if (now_ns < due_ns) {
            clock_sleep_until_ns(now_ns + SLEEP_MAX_NS < due_ns ? now_ns + SLEEP_MAX_NS : due_ns);
            continue;
        }
        world_mirror_take(mirror);
        now_ns = clock_now_ns();
        due_ns = now_ns + (uint64_t)(NS_PER_S / options->rate_hz);
        bool live = world_mirror_live(mirror, now_ns);
        if (!live && now_ns < notice_ns)
            continue;
        notice_ns = live ? 0 : now_ns + NOTICE_NS;
        status_lines_status(line, mirror, now_ns);
        if (options->json ? !print_json(mirror, options, now_ns)
                          : puts(line) < 0 || !plain_output_flush())
            return EXIT_REFUSED; /* the reader has gone */
    }
    return EXIT_OK;
}
