/* The client side of commands: it sends commands to a world and takes the replies.
 *
 * A command is repeated under its key (source, sequence) until a reply of that key comes, so that
 * it is done once even if the intake is killed. Several commands may wait at a time, also those of
 * several sources. One thread at a time. */
#ifndef JOLON_IPC_TOPICS_COMMAND_CLIENT_H
#define JOLON_IPC_TOPICS_COMMAND_CLIENT_H

#include "ipc/segment/segment.h"
#include "ipc/topics/command_link.h"

#include <stdint.h>

#define COMMAND_CLIENT_WAITING_MAX 256u
#define COMMAND_CLIENT_REPEAT_NS   150000000u

struct command_client {
    struct command_link link;
    uint64_t source;   /* its own: random, not 0 */
    uint64_t sequence; /* of the last command sent */
    uint32_t count;
    struct command_client_call {
        jolon_Command command;
        jolon_CommandReply reply;
        uint64_t repeat_ns; /* CLOCK_MONOTONIC */
        bool answered;
    } call[COMMAND_CLIENT_WAITING_MAX]; /* [count] sent and not yet forgotten, the oldest first */
};

/* Takes an open link, and chooses a source. 0, or -1 with the reason. */
int command_client_open(struct command_client *client, struct command_link link,
                        struct error_text *error);

/* A random source that no other sender has: 53 bits, which programs that know only doubles keep. 0
 * when there are no random numbers. */
uint64_t command_client_source(void);

/* Sends a command, from the client's own source when it names none, and keeps it for repetition. A
 * DRIVE takes the place of those of its source and entity that wait: an older one, repeated, would
 * undo it. Its sequence; 0 when COMMAND_CLIENT_WAITING_MAX wait. Does not block. */
uint64_t command_client_send(struct command_client *client, const jolon_Command *command);

/* Takes the replies that came and repeats what waits for one. Does not block. */
void command_client_turn(struct command_client *client);

/* True when the command was answered: reply says how, and the client has forgotten it. */
bool command_client_answered(struct command_client *client, uint64_t sequence,
                             jolon_CommandReply *reply);

/* No longer waits for it. It may still be done. */
void command_client_forget(struct command_client *client, uint64_t sequence);

/* When command_client_turn() has something to repeat [CLOCK_MONOTONIC ns]; UINT64_MAX: nothing
 * waits. */
uint64_t command_client_due_ns(const struct command_client *client);

/* Sends and waits until the reply, a request to stop (process_stopping()), or until_ns
 * (CLOCK_MONOTONIC). True with the reply. */
bool command_client_call(struct command_client *client, const jolon_Command *command,
                         uint64_t until_ns, jolon_CommandReply *reply);

/* Is there an intake that takes commands for this world? */
bool command_client_heard(const struct command_client *client);

/* A descriptor that is readable when command_client_turn() may have a reply to take, -1: none now.
 */
int command_client_descriptor(const struct command_client *client);

/* Waits for a reply, until until_ns (CLOCK_MONOTONIC), or until the next repetition is due. */
void command_client_wait(const struct command_client *client, uint64_t until_ns);

#endif
