/* The desk: orders taken from the program and not yet answered, each under the program's own id.
 *
 * Orders of one vehicle are sent in the order they came, the next when the one before is answered;
 * what concerns the whole world (pause, step ...) is sent after all before it, and before all after
 * it. A drive takes the place of an older one of its vehicle that is not answered yet. */
#ifndef JOLON_HARNESS_DESK_H
#define JOLON_HARNESS_DESK_H

#include "harness/leases.h"
#include "harness/output.h"
#include "topics/mission.h"

#define DESK_MAX    128u
#define DESK_ID_MAX 80u

struct desk {
    struct caller *caller;
    struct output *output;
    struct leases *leases;
    uint64_t timeout_ns;
    bool unanswered; /* a reply did not come in time */
    uint32_t count;
    struct desk_item {
        char id[DESK_ID_MAX]; /* as JSON; "": it is our own, nobody hears the answer */
        bool begun;
        uint64_t until_ns;
        struct mission mission;
    } item[DESK_MAX]; /* [count], the oldest first */
};

bool desk_room(const struct desk *desk);

/* Takes an order that is resolved; there must be room. */
void desk_add(struct desk *desk, const char *id, const struct order *order);

/* Sends what may be sent and tells what is answered. Does not block. */
void desk_turn(struct desk *desk, uint64_t now_ns);

/* When desk_turn() has something to do [CLOCK_MONOTONIC ns], UINT64_MAX: when an answer comes. */
uint64_t desk_due_ns(const struct desk *desk);

#endif
