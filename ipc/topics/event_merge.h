/* The tail of events: each once and in order, out of five topics that deliver at least once.
 *
 * Topics run side by side, so an event waits EVENT_MERGE_HOLD_NS for earlier ones before it is
 * handed on. A restarted reporter sends some again: they are dropped by their number. What a topic
 * says went before and never came is counted as missed. */
#ifndef JOLON_IPC_TOPICS_EVENT_MERGE_H
#define JOLON_IPC_TOPICS_EVENT_MERGE_H

#include "ipc/topics/dds_topics.h"

#include "status.h"

#include <stdbool.h>

#define EVENT_MERGE_TOPICS  5u
#define EVENT_MERGE_HOLD_NS 100000000u
#define EVENT_MERGE_FIRST_NS                                                                       \
    700000000u /* at the start: each topic's history comes at its own pace */
#define EVENT_MERGE_LINE_MAX 1024u

/* Repeats are known among so many numbers in a row: a restarted reporter sends at most the events
 * of its last second again, and 4096. */
#define EVENT_MERGE_SEEN 65536u

/* Writes an event as one line, without its newline, into line. */
typedef void event_merge_format(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic,
                                const void *event);

/* Takes a line; false to stop for now: the rest is kept. */
typedef bool event_merge_print(void *context, const char *line);

struct event_merge_entry {
    uint64_t epoch; /* worlds seen before its own */
    uint64_t sequence, came_ns;
    char *line;
};

struct event_merge_seen {
    uint64_t run, sequence;
    bool any;
};

struct event_merge {
    dds_entity_t reader[EVENT_MERGE_TOPICS];
    dds_entity_t waitset;
    event_merge_format *format;
    uint64_t settled_ns; /* nothing is handed on before */
    uint64_t run, epoch; /* of the latest event */
    struct {
        uint64_t run, sequence;
        bool any;
    } last[EVENT_MERGE_TOPICS];
    struct event_merge_seen *seen;   /* [EVENT_MERGE_SEEN], by number */
    struct event_merge_entry *entry; /* [count], not yet handed on */
    uint32_t count, room;
    uint64_t missed;
};

/* Makes the readers; -1 with the reason. */
int event_merge_open(struct event_merge *tail, const struct dds_link *link,
                     event_merge_format *format, struct error_text *error);
void event_merge_close(struct event_merge *tail);

/* Takes what has come and hands on what waited long enough, in order. False when there was no
 * memory for an event or print said so. Blocks only where print does. */
bool event_merge_turn(struct event_merge *tail, event_merge_print *print, void *context);

#endif
