/* Who sends commands to a world and hears what became of them.
 *
 * A command is repeated under its key (source, sequence) until a reply of that key comes, so that
 * it is done once even if the reporter is killed. Several may wait at a time, and of several
 * senders. One thread at a time. */
#ifndef JOLON_TOPICS_CALLER_H
#define JOLON_TOPICS_CALLER_H

#include "ipc/segment.h"
#include "topics/command_link.h"

#include <stdint.h>

#define CALLER_WAITING_MAX 256u
#define CALLER_REPEAT_NS   150000000u

struct caller {
    struct command_link link;
    uint64_t source;   /* its own: random, not 0 */
    uint64_t sequence; /* of the last command sent */
    uint32_t count;
    struct caller_call {
        jolon_Command command;
        jolon_CommandReply reply;
        uint64_t repeat_ns; /* CLOCK_MONOTONIC */
        bool answered;
    } call[CALLER_WAITING_MAX]; /* [count] sent and not yet forgotten, the oldest first */
};

/* Takes an open link, and chooses a source. 0, or -1 with the reason. */
int caller_open(struct caller *caller, struct command_link link, struct reason *reason);

/* A random source that no other sender has: 53 bits, which programs that know only doubles keep. 0
 * when there are no random numbers. */
uint64_t caller_source(void);

/* Sends a command, from the caller's own source when it names none, and keeps it for repetition. A
 * DRIVE takes the place of those of its source and entity that wait: an older one, repeated, would
 * undo it. Its sequence; 0 when CALLER_WAITING_MAX wait. Does not block. */
uint64_t caller_send(struct caller *caller, const jolon_Command *command);

/* Takes the replies that came and repeats what waits for one. Does not block. */
void caller_turn(struct caller *caller);

/* True when the command was answered: reply says how, and the caller has forgotten it. */
bool caller_answered(struct caller *caller, uint64_t sequence, jolon_CommandReply *reply);

/* No longer waits for it. It may still be done. */
void caller_forget(struct caller *caller, uint64_t sequence);

/* When caller_turn() has something to repeat [CLOCK_MONOTONIC ns]; UINT64_MAX: nothing waits. */
uint64_t caller_due_ns(const struct caller *caller);

/* Sends and waits until the reply, a request to stop (process_stopping()), or until_ns
 * (CLOCK_MONOTONIC). True with the reply. */
bool caller_call(struct caller *caller, const jolon_Command *command, uint64_t until_ns,
                 jolon_CommandReply *reply);

/* Does anybody take commands for this world? */
bool caller_heard(const struct caller *caller);

/* A descriptor that is readable when caller_turn() may have a reply to take, -1: none now. */
int caller_descriptor(const struct caller *caller);

/* Waits for a reply, until until_ns (CLOCK_MONOTONIC), or until the next repetition is due. */
void caller_wait(const struct caller *caller, uint64_t until_ns);

#endif
