/* Orders under way: an order's rounds sent when they are due, each answered once.
 *
 * A fire mission is a row of commands, one every so often; any other order is a row of one. Its
 * sequences run in the caller that it was given. The times of all functions are of one clock of the
 * caller's choice. One thread. */
#ifndef JOLON_TOPICS_MISSION_H
#define JOLON_TOPICS_MISSION_H

#include "topics/caller.h"
#include "topics/order.h"

#define MISSION_WAITING_MAX 32u /* rounds sent and not yet answered */

struct mission {
    struct order order;
    uint32_t seed;   /* where its rounds fall; by chance when none was said */
    uint64_t due_ns; /* of the next round */
    uint32_t sent, answered, done;
    uint32_t waiting;
    struct mission_round {
        uint64_t sequence; /* the caller's */
        uint32_t round;
    } round[MISSION_WAITING_MAX]; /* [waiting] */
};

/* Begins it: the first round is due at once. */
void mission_begin(struct mission *mission, const struct order *order, uint64_t now_ns);

/* Sends what is due, if the caller has room for it. */
void mission_send(struct mission *mission, struct caller *caller, uint64_t now_ns);

/* Takes an answer that the caller has. True with the reply and its round, from 0. */
bool mission_answer(struct mission *mission, struct caller *caller, jolon_CommandReply *reply,
                    uint32_t *round);

/* Is every round answered? */
bool mission_over(const struct mission *mission);

/* When mission_send() has something to do [ns]; UINT64_MAX: everything is sent,
 * or answers come first. */
uint64_t mission_due_ns(const struct mission *mission);

/* Its unanswered rounds are no longer waited for; they may still be done. */
void mission_forget(struct mission *mission, struct caller *caller);

#endif
