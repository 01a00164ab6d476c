/* Events into the ring. */
#include "collider/sink.h"

#include <stddef.h>
#include <xxhash.h>

struct event *sink_event(struct sink *sink, enum event_type type)
{
    if (sink->count >= sink->most) {
        sink->tally->events_dropped++;
        return NULL;
    }
    uint64_t sequence = sink->first + sink->count;
    struct event *event = &sink->slot[sequence & (sink->slots - 1)];
    *event = (struct event){.sequence = sequence,
                            .frame = sink->frame,
                            .tick = sink->tick,
                            .index = sink->count,
                            .type = type};
    sink->count++;
    return event;
}

uint64_t sink_digest(const struct sink *sink, uint64_t digest)
{
    for (uint32_t i = 0; i < sink->count; i++)
        digest = XXH3_64bits_withSeed(&sink->slot[(sink->first + i) & (sink->slots - 1)],
                                      sizeof(struct event), digest);
    return digest;
}
