/* The shots and detonations of other simulators that have come: to know a copy, which the network
 * or a gateway that started anew has made, from another shot with the same number, and to know
 * where a round was fired. Events have 16 bits a simulation, simulations that start anew count from
 * the beginning again, and a burst may have one number for all its rounds. So a number is the same
 * event only for a short time, and only of the same munition, target and place. One thread. */
#ifndef JOLON_GATEWAY_EVENT_MEMORY_H
#define JOLON_GATEWAY_EVENT_MEMORY_H

#include "world/entity/remote.h"
#include "world/maths/maths.h"

#include <stdbool.h>

#define EVENT_MEMORY_EVENTS 4096u /* a power of two */

/* A copy comes within this time [s], and is of a place at most this far away [m]. A gateway that
 * was killed tells its last events again when it has started: within some seconds. */
#define EVENT_MEMORY_COPY_S 5.0
#define EVENT_MEMORY_COPY_M 1.0

/* No munition is in flight for longer [s]. */
#define EVENT_MEMORY_FLIGHT_S 300.0

struct told_event {
    uint64_t event; /* remote_id() of the event and more; 0: it has no number */
    uint64_t firer; /* remote_id() */
    uint32_t type;  /* enum remote_type */
    uint32_t entity;
    uint16_t kind;
    bool placed;       /* place is known */
    struct vec3 place; /* [m, world] of the muzzle, or of the detonation */
    uint64_t heard_ns;
};

struct event_memory {
    struct told_event shot[EVENT_MEMORY_EVENTS];
    uint32_t count; /* that were ever noted */
};

/* Returns what a record says of a shot, without its place. */
struct told_event event_memory_of(const struct remote_record *record, uint64_t now_ns);

void event_memory_note(struct event_memory *memory, const struct told_event *shot);

/* Returns true if the shot has come before. */
bool event_memory_has(const struct event_memory *memory, const struct told_event *shot);

/* Returns the last FIRE of an event by this firer, NULL when none is remembered. */
const struct told_event *event_memory_fire(const struct event_memory *memory, uint64_t event,
                                           uint64_t firer, uint64_t now_ns);

#endif
