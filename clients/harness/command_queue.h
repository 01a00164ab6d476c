/* Queue of the program's commands that are not answered yet, each under the program's id.
 *
 * The commands of a vehicle are sent in their order, each when the one before it is answered. A
 * command for the whole world (pause, step ...) waits for all commands before it, and those after
 * it wait for it. A drive replaces an older drive of its vehicle that is not answered yet. */
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
    bool no_reply; /* the reply to a command did not come in time */
    uint32_t count;
    struct command_queue_item {
        char id[COMMAND_QUEUE_ID_MAX]; /* as JSON; "": the harness's own command, without answer */
        bool begun;
        uint64_t until_ns;
        struct command_series series;
    } item[COMMAND_QUEUE_MAX]; /* [count], the oldest first */
};

bool command_queue_room(const struct command_queue *queue);

/* Appends a resolved command. There must be room. */
void command_queue_add(struct command_queue *queue, const char *id,
                       const struct command_text *order);

/* Sends the commands that may be sent and writes the answers of those with a reply. Does not block.
 */
void command_queue_turn(struct command_queue *queue, uint64_t now_ns);

/* Returns when command_queue_turn() is due [CLOCK_MONOTONIC ns]; UINT64_MAX: at the next reply. */
uint64_t command_queue_due_ns(const struct command_queue *queue);

#endif
