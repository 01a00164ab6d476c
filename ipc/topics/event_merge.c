/* Takes events, drops repeats and sorts. */
#include "ipc/topics/event_merge.h"

#include "ipc/process/clock.h"
#include "ipc/topics/samples.h"

#include <stdlib.h>
#include <string.h>

/* Every event type begins with its header. */
_Static_assert(offsetof(jolon_CollisionEvent, header) == 0, "header first");
_Static_assert(offsetof(jolon_FireEvent, header) == 0, "header first");
_Static_assert(offsetof(jolon_DetonationEvent, header) == 0, "header first");
_Static_assert(offsetof(jolon_CraterEvent, header) == 0, "header first");
_Static_assert(offsetof(jolon_AgentEvent, header) == 0, "header first");
_Static_assert(offsetof(jolon_ContactEndEvent, header) == 0, "header first");

int event_merge_open(struct event_merge *merge, const struct dds_link *link,
                     event_merge_format *format, struct error_text *error)
{
    *merge = (struct event_merge){
        .link = link, .format = format, .settled_ns = clock_now_ns() + EVENT_MERGE_FIRST_NS};
    merge->seen = calloc(EVENT_MERGE_SEEN, sizeof *merge->seen);
    if (!merge->seen)
        return error_text_set(error, "out of memory for the numbers of events");
    for (uint32_t i = 0; i < EVENT_TOPIC_COUNT; i++) {
        merge->reader[i] = dds_topics_reader(link, (enum dds_topic)(TOPIC_EVENTS + i), error);
        if (merge->reader[i] < 0)
            return -1;
    }
    merge->waitset = dds_topics_waitset(link, merge->reader, EVENT_TOPIC_COUNT, error);
    return merge->waitset < 0 ? -1 : 0;
}

void event_merge_close(struct event_merge *merge)
{
    for (uint32_t i = 0; i < merge->count; i++)
        free(merge->entry[i].line);
    free(merge->entry);
    free(merge->seen);
    merge->entry = NULL;
    merge->seen = NULL;
    merge->count = merge->room = 0;
}

static struct event_merge_seen *place_of(struct event_merge *merge, uint64_t sequence)
{
    return &merge->seen[sequence % EVENT_MERGE_SEEN];
}

static bool seen(struct event_merge *merge, const jolon_EventHeader *header)
{
    const struct event_merge_seen *place = place_of(merge, header->sequence);
    return place->any && place->run == header->run && place->sequence == header->sequence;
}

/* Returns false for a repeat. Repeats are recognised by their own numbers: if every number below
 * the highest were dropped, a false high number would silence the topic for good. */
static bool is_new(struct event_merge *merge, uint32_t topic, const jolon_EventHeader *header)
{
    bool same_run = merge->last[topic].any && merge->last[topic].run == header->run;
    if (seen(merge, header))
        return false;
    if (same_run && header->previous > merge->last[topic].sequence &&
        header->previous < header->sequence)
        merge->missed++; /* at least one; the topic does not say how many */
    *place_of(merge, header->sequence) =
        (struct event_merge_seen){header->run, header->sequence, true};
    merge->last[topic].any = true;
    merge->last[topic].run = header->run;
    merge->last[topic].sequence = header->sequence;
    return true;
}

static bool keep(struct event_merge *merge, uint32_t topic, const void *event, uint64_t now_ns)
{
    char line[EVENT_MERGE_LINE_MAX];
    const jolon_EventHeader *header = event;
    if (!is_new(merge, topic, header))
        return true;
    if (merge->count == merge->room) {
        uint32_t room = merge->room ? merge->room * 2 : 256;
        struct event_merge_entry *entry = realloc(merge->entry, room * sizeof *entry);
        if (!entry)
            return false;
        merge->entry = entry;
        merge->room = room;
    }
    merge->format(line, (enum dds_topic)(TOPIC_EVENTS + topic), event);
    char *copy = strdup(line);
    if (!copy)
        return false;
    if (merge->run != header->run) {
        merge->run = header->run;
        merge->epoch++;
    }
    merge->entry[merge->count++] = (struct event_merge_entry){
        .epoch = merge->epoch, .sequence = header->sequence, .came_ns = now_ns, .line = copy};
    return true;
}

static bool take(struct event_merge *merge, uint64_t now_ns)
{
    const bool single = dds_link_is_single(merge->link);
    bool kept = true;
    for (uint32_t i = 0; i < EVENT_TOPIC_COUNT; i++) {
        struct samples from = {.reader = merge->reader[i],
                               .topic = (enum dds_topic)(TOPIC_EVENTS + i)};
        while (samples_next(&from))
            kept = kept && (!single || keep(merge, i, from.sample, now_ns));
    }
    return kept;
}

static int in_order(const void *left, const void *right)
{
    const struct event_merge_entry *a = left;
    const struct event_merge_entry *b = right;
    if (a->epoch != b->epoch)
        return a->epoch < b->epoch ? -1 : 1;
    return a->sequence < b->sequence ? -1 : a->sequence > b->sequence;
}

bool event_merge_poll(struct event_merge *merge, event_merge_print *print, void *context)
{
    uint64_t now_ns = clock_now_ns();
    bool good = take(merge, now_ns);
    if (merge->count > 1)
        qsort(merge->entry, merge->count, sizeof *merge->entry, in_order);
    uint32_t done = 0;
    while (good && now_ns >= merge->settled_ns && done < merge->count &&
           now_ns - merge->entry[done].came_ns >= EVENT_MERGE_HOLD_NS) {
        good = print(context, merge->entry[done].line);
        free(merge->entry[done].line);
        done++;
    }
    merge->count -= done;
    if (done)
        memmove(merge->entry, merge->entry + done, merge->count * sizeof *merge->entry);
    return good;
}
