/* Verb events: prints the run's events in order, once or continuously. */
#include "ipc/frame/event_cursor.h"
#include "ipc/segment/segment_attach.h"
#include "supervisor/worldctl/verbs.h"

#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "recorder/replay/arguments.h"
#include "ipc/json/world_json.h"
#include "world/entity/event.h"
#include "world/event_text.h"
#include "world/runtime/parse_number.h"

#include <inttypes.h>
#include <stdio.h>

#define BATCH   256
#define WAIT_NS (20 * (uint64_t)NS_PER_MS)

static void print_plain(const struct world *world, const struct event *event)
{
    cJSON *object = json_event(world, event);
    cJSON_DeleteItemFromObject(object, "frame");
    cJSON_DeleteItemFromObject(object, "index");
    cJSON_DeleteItemFromObject(object, "time_s");
    cJSON_DeleteItemFromObject(object, "type");
    char *text = cJSON_PrintUnformatted(object);
    if (!text)
        die_refused("out of memory while writing an event");
    printf("%8" PRIu64 ".%-3u %-10s %s\n", event->frame, event->index,
           event_type_name((enum event_type)event->type), text);
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

int verb_events(const struct arguments *arguments)
{
    static struct event events[BATCH];
    uint64_t from = 0;
    if (arguments->from && !parse_whole(arguments->from, 0, UINT64_MAX, &from))
        die_usage("--from %s: must be a frame's number", arguments->from);
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
            if (events[i].frame < from)
                continue;
            if (arguments->json)
                json_print(json_event(&view.world, &events[i]));
            else
                print_plain(&view.world, &events[i]);
        }
        if (count > 0)
            continue;
        if (!arguments->follow || process_stopping() || frame_protocol_finished(&view) ||
            ferror(stdout))
            break;
        fflush(stdout);
        frame_protocol_wait(&view, seen, clock_now_ns() + WAIT_NS);
    }
    segment_detach(&view);
    return ferror(stdout) ? EXIT_REFUSED : EXIT_OK;
}
