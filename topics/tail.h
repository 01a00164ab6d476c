/* The tail of events: each once and in order, out of five topics that deliver at least once.
 *
 * Topics run side by side, so an event waits TAIL_HOLD_NS for earlier ones before it is handed
 * on. A restarted reporter sends some again: they are dropped by their number. What a topic says
 * went before and never came is counted as missed. */
#ifndef JOLON_TOPICS_TAIL_H
#define JOLON_TOPICS_TAIL_H

#include "topics/dds_topics.h"

#include "status.h"

#include <stdbool.h>

#define TAIL_TOPICS   5u
#define TAIL_HOLD_NS  100000000u
#define TAIL_FIRST_NS 700000000u /* at the start: each topic's history comes at its own pace */
#define TAIL_LINE_MAX 1024u

/* Repeats are known among so many numbers in a row: a restarted reporter sends at most the events
 * of its last second again, and 4096. */
#define TAIL_SEEN 65536u

/* Writes an event as one line, without its newline, into line. */
typedef void tail_format(char line[TAIL_LINE_MAX], enum dds_topic topic, const void *event);

/* Takes a line; false to stop for now: the rest is kept. */
typedef bool tail_print(void *context, const char *line);

struct tail_entry {
    uint64_t epoch; /* worlds seen before its own */
    uint64_t sequence, came_ns;
    char *line;
};

struct tail_seen {
    uint64_t run, sequence;
    bool any;
};

struct tail {
    dds_entity_t reader[TAIL_TOPICS];
    dds_entity_t waitset;
    tail_format *format;
    uint64_t settled_ns; /* nothing is handed on before */
    uint64_t run, epoch; /* of the latest event */
    struct {
        uint64_t run, sequence;
        bool any;
    } last[TAIL_TOPICS];
    struct tail_seen *seen;   /* [TAIL_SEEN], by number */
    struct tail_entry *entry; /* [count], not yet handed on */
    uint32_t count, room;
    uint64_t missed;
};

/* Makes the readers; -1 with the reason. */
int tail_open(struct tail *tail, const struct dds_link *link, tail_format *format,
              struct reason *reason);
void tail_close(struct tail *tail);

/* Takes what has come and hands on what waited long enough, in order. False when there was no
 * memory for an event or print said so. Blocks only where print does. */
bool tail_turn(struct tail *tail, tail_print *print, void *context);

#endif
