/* The desk: orders taken from the program and not yet answered, each under the program's own id.
 *
 * Orders of one vehicle are sent in the order they came, the next when the one before is answered;
 * what concerns the whole world (pause, step ...) is sent after all before it, and before all after
 * it. A drive takes the place of an older one of its vehicle that is not answered yet. */
#ifndef JOLON_CLIENTS_HARNESS_COMMAND_QUEUE_H
#define JOLON_CLIENTS_HARNESS_COMMAND_QUEUE_H

#include "clients/harness/leases.h"
#include "clients/harness/output.h"
#include "ipc/topics/command_series.h"

#define COMMAND_QUEUE_MAX    128u
#define COMMAND_QUEUE_ID_MAX 80u

struct command_queue {
    struct command_client *client;
    struct output *output;
    struct leases *leases;
    uint64_t timeout_ns;
    bool no_reply; /* a reply did not come in time */
    uint32_t count;
    struct command_queue_item {
        char id[COMMAND_QUEUE_ID_MAX]; /* as JSON; "": it is our own, nobody hears the answer */
        bool begun;
        uint64_t until_ns;
        struct command_series series;
    } item[COMMAND_QUEUE_MAX]; /* [count], the oldest first */
};

bool command_queue_room(const struct command_queue *queue);

/* Takes an order that is resolved; there must be room. */
void command_queue_add(struct command_queue *queue, const char *id,
                       const struct command_text *order);

/* Sends what may be sent and tells what is answered. Does not block. */
void command_queue_turn(struct command_queue *queue, uint64_t now_ns);

/* When command_queue_turn() has something to do [CLOCK_MONOTONIC ns], UINT64_MAX: when an answer
 * comes. */
uint64_t command_queue_due_ns(const struct command_queue *queue);

#endif
