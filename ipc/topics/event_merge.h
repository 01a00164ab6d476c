/* Merges the events of all event topics, which deliver at least once, into one ordered sequence
 * without repeats.
 *
 * An event waits EVENT_MERGE_HOLD_NS for earlier events of other topics before it is printed. A
 * restarted reporter sends some events again; they are dropped by their number. Events that a topic
 * names as earlier but that never came are counted as missed. */
#ifndef JOLON_IPC_TOPICS_EVENT_MERGE_H
#define JOLON_IPC_TOPICS_EVENT_MERGE_H

#include "ipc/topics/dds_topics.h"

#include "status.h"

#include <stdbool.h>

#define EVENT_MERGE_HOLD_NS  100000000u
#define EVENT_MERGE_FIRST_NS 700000000u /* at the start, when each topic sends its history */
#define EVENT_MERGE_LINE_MAX 1024u

/* The range of consecutive numbers in which repeats are recognised. A restarted reporter sends the
 * events of its last second again, and at least 4096. */
#define EVENT_MERGE_SEEN 65536u

/* Writes an event as one line, without its newline, into line. */
typedef void event_merge_format(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic,
                                const void *event);

/* Takes a line. Returns false to stop for now; the rest is kept. */
typedef bool event_merge_print(void *context, const char *line);

struct event_merge_entry {
    uint64_t epoch; /* number of worlds seen before this event's */
    uint64_t sequence, came_ns;
    char *line;
};

struct event_merge_seen {
    uint64_t run, sequence;
    bool any;
};

struct event_merge {
    const struct dds_link *link; /* the caller's */
    dds_entity_t reader[EVENT_TOPIC_COUNT];
    dds_entity_t waitset;
    event_merge_format *format;
    uint64_t settled_ns; /* nothing is printed before */
    uint64_t run, epoch; /* of the latest event */
    struct {
        uint64_t run, sequence;
        bool any;
    } last[EVENT_TOPIC_COUNT];
    struct event_merge_seen *seen;   /* [EVENT_MERGE_SEEN], by sequence */
    struct event_merge_entry *entry; /* [count], not yet printed */
    uint32_t count, room;
    uint64_t missed;
};

/* Makes the readers. Returns 0, or -1 with the reason. */
int event_merge_open(struct event_merge *merge, const struct dds_link *link,
                     event_merge_format *format, struct error_text *error);
void event_merge_close(struct event_merge *merge);

/* Takes the events that came and prints, in order, those that have waited long enough. Returns
 * false when there was no memory for an event or print returned false. Blocks only where print
 * does. */
bool event_merge_poll(struct event_merge *merge, event_merge_print *print, void *context);

#endif
