/* Orders under way: an order's rounds sent when they are due, each answered once.
 *
 * A fire mission is a row of commands, one every so often; any other order is a row of one. Its
 * sequences run in the caller that it was given. The times of all functions are of one clock of the
 * caller's choice. One thread. */
#ifndef JOLON_IPC_TOPICS_COMMAND_SERIES_H
#define JOLON_IPC_TOPICS_COMMAND_SERIES_H

#include "ipc/topics/command_client.h"
#include "ipc/topics/command_text.h"

#define COMMAND_SERIES_WAITING_MAX 32u /* rounds sent and not yet answered */

struct command_series {
    struct command_text order;
    uint32_t seed;   /* where its rounds fall; by chance when none was said */
    uint64_t due_ns; /* of the next round */
    uint32_t sent, answered, done;
    uint32_t waiting;
    struct command_series_round {
        uint64_t sequence; /* the caller's */
        uint32_t round;
    } round[COMMAND_SERIES_WAITING_MAX]; /* [waiting] */
};

/* Begins it: the first round is due at once. */
void command_series_begin(struct command_series *series, const struct command_text *order,
                          uint64_t now_ns);

/* Sends what is due, if the caller has room for it. */
void command_series_send(struct command_series *series, struct command_client *client,
                         uint64_t now_ns);

/* Takes an answer that the caller has. True with the reply and its round, from 0. */
bool command_series_answer(struct command_series *series, struct command_client *client,
                           jolon_CommandReply *reply, uint32_t *round);

/* Is every round answered? */
bool command_series_over(const struct command_series *series);

/* When command_series_send() has something to do [ns]; UINT64_MAX: everything is sent,
 * or answers come first. */
uint64_t command_series_due_ns(const struct command_series *series);

/* Its unanswered rounds are no longer waited for; they may still be done. */
void command_series_forget(struct command_series *series, struct command_client *client);

#endif
