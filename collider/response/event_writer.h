/* The frame's events, written into the ring from the committed end on. A frame holds at most
 * events_per_frame; the counter of dropped events counts the rest. */
#ifndef JOLON_COLLIDER_RESPONSE_EVENT_WRITER_H
#define JOLON_COLLIDER_RESPONSE_EVENT_WRITER_H

#include "world/entity/event.h"

struct counters;

struct event_writer {
    struct event *slot;
    uint64_t slots; /* power of two */
    uint64_t first; /* sequence of the frame's first event */
    uint64_t frame, tick;
    uint32_t count, most;
    struct counters *tally;
};

/* Returns a new event of this type, all zero except its key; NULL if the frame has no room left. */
struct event *event_writer_event(struct event_writer *events, enum event_type type);

/* Returns the digest of the frame's events and of all before them. */
uint64_t event_writer_digest(const struct event_writer *events, uint64_t digest);

#endif
