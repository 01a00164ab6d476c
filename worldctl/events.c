/* Verb events: the run's events in order, once or as they come; and the recorder, which is the same
 * into a file that a kill cannot spoil. */
#include "worldctl/verbs.h"

#include "ipc/clock.h"
#include "ipc/frame.h"
#include "ipc/log.h"
#include "ipc/process.h"
#include "worldctl/arguments.h"
#include "worldctl/json.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define BATCH          256
#define WAIT_NS        (20 * (uint64_t)NS_PER_MS)
#define LINE_MAX_BYTES 4096

static void print_plain(const struct world *world, const struct event *event)
{
    cJSON *object = json_event(world, event);
    cJSON_DeleteItemFromObject(object, "frame");
    cJSON_DeleteItemFromObject(object, "index");
    cJSON_DeleteItemFromObject(object, "time_s");
    cJSON_DeleteItemFromObject(object, "type");
    char *text = cJSON_PrintUnformatted(object);
    printf("%8" PRIu64 ".%-3u %-10s %s\n", event->frame, event->index,
           event_type_name((enum event_type)event->type), text ? text : "");
    cJSON_free(text);
    cJSON_Delete(object);
}

static void print_gap(const struct arguments *arguments, uint64_t gap)
{
    if (arguments->json)
        printf("{\"type\":\"gap\",\"lost\":%" PRIu64 "}\n", gap);
    else
        printf("... %" PRIu64 " events lost: the ring had gone round\n", gap);
}

static int print_events(const struct arguments *arguments)
{
    static struct event events[BATCH];
    struct event_cursor cursor = {0};
    struct view view;
    arguments_attach(arguments, &view);
    process_signals();
    for (;;) {
        uint64_t seen = atomic_load(&view.commit->commit);
        uint32_t count = events_read(&view, &cursor, events, BATCH);
        if (cursor.gap > 0)
            print_gap(arguments, cursor.gap);
        cursor.gap = 0;
        for (uint32_t i = 0; i < count; i++) {
            if (events[i].frame < arguments->from_frame)
                continue;
            if (arguments->json)
                json_print(json_event(&view.world, &events[i]));
            else
                print_plain(&view.world, &events[i]);
        }
        if (count > 0)
            continue;
        if (!arguments->follow || process_stopping() || frame_finished(&view) || ferror(stdout))
            break;
        fflush(stdout);
        frame_wait(&view, seen, clock_now_ns() + WAIT_NS);
    }
    segment_detach(&view);
    return ferror(stdout) ? EXIT_REFUSED : EXIT_OK;
}

/* --- the recorder ------------------------------------------------------------------------------*/

/* Where the log ends: cuts off a last line that a kill tore, and takes the sequence that the last
 * whole line carries. The next event's sequence, 0 for an empty log. */
static uint64_t resume_log(int fd, const char *path)
{
    char tail[2 * LINE_MAX_BYTES + 1];
    struct stat status;
    if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode))
        die_refused("--log %s: must be a plain file", path);
    off_t begin =
        status.st_size > (off_t)sizeof tail - 1 ? status.st_size - (off_t)sizeof tail + 1 : 0;
    ssize_t length = pread(fd, tail, sizeof tail - 1, begin);
    if (length < 0)
        die_refused("--log %s: cannot read: %s", path, strerror(errno));
    while (length > 0 && tail[length - 1] != '\n')
        length--;
    if (ftruncate(fd, begin + length) != 0 || lseek(fd, 0, SEEK_END) < 0)
        die_refused("--log %s: cannot cut off its torn last line: %s", path, strerror(errno));
    if (length == 0)
        return 0;
    tail[length] = '\0';
    ssize_t line = length - 1;
    while (line > 0 && tail[line - 1] != '\n')
        line--;
    cJSON *last = cJSON_Parse(tail + line);
    const cJSON *sequence = cJSON_GetObjectItem(last, "sequence");
    if (!cJSON_IsNumber(sequence))
        die_refused("--log %s: is no event log of Jolon; name another file", path);
    uint64_t next = (uint64_t)sequence->valuedouble + 1;
    cJSON_Delete(last);
    return next;
}

/* One write a line, whole or (when a kill comes between) torn and cut off at the next start. */
static void append(int fd, const char *path, cJSON *object)
{
    char *text = cJSON_PrintUnformatted(object);
    if (!text)
        die_refused("out of memory while writing --log %s", path);
    size_t length = strlen(text);
    text[length++] = '\n'; /* in place of the NUL */
    for (size_t done = 0; done < length;) {
        ssize_t wrote = write(fd, text + done, length - done);
        if (wrote < 0 && errno == EINTR)
            continue;
        if (wrote < 0)
            die_refused("--log %s: cannot write: %s", path, strerror(errno));
        done += (size_t)wrote;
    }
    cJSON_free(text);
    cJSON_Delete(object);
}

static void append_gap(int fd, const char *path, const struct event_cursor *cursor, uint64_t next)
{
    cJSON *object = cJSON_CreateObject();
    json_text(object, "type", "gap");
    json_whole(object, "lost", cursor->gap);
    json_whole(object, "sequence", next - 1);
    append(fd, path, object);
    log_warn("%" PRIu64 " events lost: the ring had gone round", cursor->gap);
}

static int record_events(const struct arguments *arguments)
{
    static struct event events[BATCH];
    struct view view;
    struct reason reason;
    log_open("recorder");
    process_signals();
    process_die_with_parent(arguments->parent);
    if (segment_attach(&view, arguments->world, ROLE_RECORDER, &reason) != 0)
        die_refused("%s", reason.text);
    int fd = open(arguments->log, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (fd < 0)
        die_refused("--log %s: cannot open: %s", arguments->log, strerror(errno));
    struct event_cursor cursor = {.next = resume_log(fd, arguments->log)};
    struct state_head head;
    if (snapshot_head(&head, &view) == 0 && cursor.next > head.event_end)
        die_refused("--log %s: holds %" PRIu64 " events, more than this world has (%" PRIu64
                    "): it is another run's; name another file",
                    arguments->log, cursor.next, head.event_end);
    segment_ready(&view);
    for (;;) {
        bool last = process_stopping();
        uint64_t seen = atomic_load(&view.commit->commit);
        uint32_t count = events_read(&view, &cursor, events, BATCH);
        frame_beat(&view);
        if (cursor.gap > 0) {
            atomic_fetch_add(&view.slot[ROLE_RECORDER]->gaps, cursor.gap);
            append_gap(fd, arguments->log, &cursor, cursor.next - count);
            cursor.gap = 0;
        }
        for (uint32_t i = 0; i < count; i++) {
            cJSON *object = json_event(&view.world, &events[i]);
            json_whole(object, "sequence", events[i].sequence);
            append(fd, arguments->log, object);
        }
        if (count > 0)
            continue;
        if (last)
            break;
        frame_wait(&view, seen, clock_now_ns() + WAIT_NS);
    }
    if (close(fd) != 0)
        die_refused("--log %s: cannot write: %s", arguments->log, strerror(errno));
    segment_detach(&view);
    return EXIT_OK;
}

int verb_events(int argc, char **argv)
{
    struct arguments arguments = arguments_read(argc, argv);
    return arguments.log ? record_events(&arguments) : print_events(&arguments);
}
