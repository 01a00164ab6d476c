/* Events into the ring. */
#include "collider/response/event_writer.h"

#include "world/state.h"

#include <stddef.h>
#include <string.h>
#include <xxhash.h>

struct event *event_writer_event(struct event_writer *sink, enum event_type type)
{
    if (sink->count >= sink->most) {
        sink->tally->events_dropped++;
        return NULL;
    }
    uint64_t sequence = sink->first + sink->count;
    struct event *event = &sink->slot[sequence & (sink->slots - 1)];
    memset(event, 0, sizeof *event); /* every byte: the digest sees them all */
    event->sequence = sequence;
    event->frame = sink->frame;
    event->tick = sink->tick;
    event->index = sink->count;
    event->type = type;
    sink->count++;
    return event;
}

uint64_t event_writer_digest(const struct event_writer *sink, uint64_t digest)
{
    for (uint32_t i = 0; i < sink->count; i++)
        digest = XXH3_64bits_withSeed(&sink->slot[(sink->first + i) & (sink->slots - 1)],
                                      sizeof(struct event), digest);
    return digest;
}
