/* Events taken, put in order, repeats dropped. */
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

int event_merge_open(struct event_merge *tail, const struct dds_link *link,
                     event_merge_format *format, struct error_text *error)
{
    *tail =
        (struct event_merge){.format = format, .settled_ns = clock_now_ns() + EVENT_MERGE_FIRST_NS};
    tail->seen = calloc(EVENT_MERGE_SEEN, sizeof *tail->seen);
    if (!tail->seen)
        return error_text_set(error, "out of memory for the numbers of events");
    for (uint32_t i = 0; i < EVENT_MERGE_TOPICS; i++) {
        tail->reader[i] = dds_topics_reader(link, (enum dds_topic)(TOPIC_COLLISION + i), error);
        if (tail->reader[i] < 0)
            return -1;
    }
    tail->waitset = dds_topics_waitset(link, tail->reader, EVENT_MERGE_TOPICS, error);
    return tail->waitset < 0 ? -1 : 0;
}

void event_merge_close(struct event_merge *tail)
{
    for (uint32_t i = 0; i < tail->count; i++)
        free(tail->entry[i].line);
    free(tail->entry);
    free(tail->seen);
    tail->entry = NULL;
    tail->seen = NULL;
    tail->count = tail->room = 0;
}

static struct event_merge_seen *place_of(struct event_merge *tail, uint64_t sequence)
{
    return &tail->seen[sequence % EVENT_MERGE_SEEN];
}

static bool seen(struct event_merge *tail, const jolon_EventHeader *header)
{
    const struct event_merge_seen *place = place_of(tail, header->sequence);
    return place->any && place->run == header->run && place->sequence == header->sequence;
}

/* False for a repeat. What came is known by its number, not by its being below the highest: a
 * number that nobody reaches would silence the topic for good. */
static bool is_new(struct event_merge *tail, uint32_t topic, const jolon_EventHeader *header)
{
    bool same_run = tail->last[topic].any && tail->last[topic].run == header->run;
    if (seen(tail, header))
        return false;
    if (same_run && header->previous > tail->last[topic].sequence &&
        header->previous < header->sequence)
        tail->missed++; /* at least one; how many the topic does not say */
    *place_of(tail, header->sequence) =
        (struct event_merge_seen){header->run, header->sequence, true};
    tail->last[topic].any = true;
    tail->last[topic].run = header->run;
    tail->last[topic].sequence = header->sequence;
    return true;
}

static bool keep(struct event_merge *tail, uint32_t topic, const void *event, uint64_t now_ns)
{
    char line[EVENT_MERGE_LINE_MAX];
    const jolon_EventHeader *header = event;
    if (!is_new(tail, topic, header))
        return true;
    if (tail->count == tail->room) {
        uint32_t room = tail->room ? tail->room * 2 : 256;
        struct event_merge_entry *entry = realloc(tail->entry, room * sizeof *entry);
        if (!entry)
            return false;
        tail->entry = entry;
        tail->room = room;
    }
    tail->format(line, (enum dds_topic)(TOPIC_COLLISION + topic), event);
    char *copy = strdup(line);
    if (!copy)
        return false;
    if (tail->run != header->run) {
        tail->run = header->run;
        tail->epoch++;
    }
    tail->entry[tail->count++] = (struct event_merge_entry){
        .epoch = tail->epoch, .sequence = header->sequence, .came_ns = now_ns, .line = copy};
    return true;
}

static bool take(struct event_merge *tail, uint64_t now_ns)
{
    bool kept = true;
    for (uint32_t i = 0; i < EVENT_MERGE_TOPICS; i++) {
        struct samples from = {.reader = tail->reader[i],
                               .topic = (enum dds_topic)(TOPIC_COLLISION + i)};
        while (samples_next(&from))
            kept = kept && keep(tail, i, from.sample, now_ns);
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

bool event_merge_turn(struct event_merge *tail, event_merge_print *print, void *context)
{
    uint64_t now_ns = clock_now_ns();
    bool good = take(tail, now_ns);
    if (tail->count > 1)
        qsort(tail->entry, tail->count, sizeof *tail->entry, in_order);
    uint32_t done = 0;
    while (good && now_ns >= tail->settled_ns && done < tail->count &&
           now_ns - tail->entry[done].came_ns >= EVENT_MERGE_HOLD_NS) {
        good = print(context, tail->entry[done].line);
        free(tail->entry[done].line);
        done++;
    }
    tail->count -= done;
    if (done)
        memmove(tail->entry, tail->entry + done, tail->count * sizeof *tail->entry);
    return good;
}
