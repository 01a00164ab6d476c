/* Events into the ring. */
#include "collider/response/event_writer.h"

#include "world/state.h"

#include <stddef.h>
#include <string.h>
#include <xxhash.h>

struct event *event_writer_event(struct event_writer *events, enum event_type type)
{
    if (events->count >= events->most) {
        events->tally->events_dropped++;
        return NULL;
    }
    uint64_t sequence = events->first + events->count;
    struct event *event = &events->slot[sequence & (events->slots - 1)];
    memset(event, 0, sizeof *event); /* every byte, since all are part of the digest */
    event->sequence = sequence;
    event->frame = events->frame;
    event->tick = events->tick;
    event->index = events->count;
    event->type = type;
    events->count++;
    return event;
}

uint64_t event_writer_digest(const struct event_writer *events, uint64_t digest)
{
    for (uint32_t i = 0; i < events->count; i++)
        digest = XXH3_64bits_withSeed(&events->slot[(events->first + i) & (events->slots - 1)],
                                      sizeof(struct event), digest);
    return digest;
}
