/* Orders in progress: sends each round of an order when it is due, and receives the answer to each.
 *
 * A fire mission is a series of commands, one every every_s; any other order is a series of one.
 * The sequences are those of the client that sends it. All times are of one clock of the caller's
 * choice. One thread. */
#ifndef JOLON_IPC_TOPICS_COMMAND_SERIES_H
#define JOLON_IPC_TOPICS_COMMAND_SERIES_H

#include "ipc/topics/command_client.h"
#include "ipc/topics/command_text.h"

#define COMMAND_SERIES_WAITING_MAX 32u /* rounds sent and not yet answered */

struct command_series {
    struct command_text order;
    uint32_t seed;   /* of the rounds' points of aim; random when none was given */
    uint64_t due_ns; /* of the next round */
    uint32_t sent, answered, done;
    uint32_t waiting;
    struct command_series_round {
        uint64_t sequence; /* of the client's call */
        uint32_t round;
    } round[COMMAND_SERIES_WAITING_MAX]; /* [waiting] */
};

/* Begins a series. Its first round is due at once. */
void command_series_begin(struct command_series *series, const struct command_text *order,
                          uint64_t now_ns);

/* Sends the rounds that are due, if the client has room for them. */
void command_series_send(struct command_series *series, struct command_client *client,
                         uint64_t now_ns);

/* Takes an answer from the client. Returns true with the reply and its round, counted from 0. */
bool command_series_answer(struct command_series *series, struct command_client *client,
                           jolon_CommandReply *reply, uint32_t *round);

/* Returns true if every round is answered. */
bool command_series_over(const struct command_series *series);

/* Returns when command_series_send() has a round to send [ns], UINT64_MAX when all are sent or
 * answers must come first. */
uint64_t command_series_due_ns(const struct command_series *series);

/* Stops waiting for the unanswered rounds. They may still be executed. */
void command_series_forget(struct command_series *series, struct command_client *client);

#endif
