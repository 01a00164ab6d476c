/* The client side of commands: it sends commands to a world and takes the replies.
 *
 * A command is repeated under its key (source, sequence) until a reply with that key comes, so it
 * is executed once even if the intake is killed. Several commands, also of several sources, may
 * wait at a time. One thread at a time. */
#ifndef JOLON_IPC_TOPICS_COMMAND_CLIENT_H
#define JOLON_IPC_TOPICS_COMMAND_CLIENT_H

#include "ipc/segment/segment.h"
#include "ipc/topics/command_link.h"

#include <stdint.h>

#define COMMAND_CLIENT_WAITING_MAX 256u
#define COMMAND_CLIENT_REPEAT_NS   150000000u

struct command_client {
    struct command_link link;
    uint64_t source;   /* the client's own: random, not 0 */
    uint64_t sequence; /* of the last command sent */
    uint32_t count;
    struct command_client_call {
        jolon_Command command;
        jolon_CommandReply reply;
        uint64_t repeat_ns; /* CLOCK_MONOTONIC */
        bool answered;
    } call[COMMAND_CLIENT_WAITING_MAX]; /* [count] sent and not yet forgotten, oldest first */
};

/* Takes an open link, and chooses a source. Returns 0, or -1 with the reason. */
int command_client_open(struct command_client *client, struct command_link link,
                        struct error_text *error);

/* Returns a random source that no other sender has, 0 when there are no random numbers. It has 53
 * bits, so that programs that know only doubles keep it exactly. */
uint64_t command_client_source(void);

/* Sends a command, from the client's own source when it names none, and keeps it for repetition. A
 * DRIVE replaces waiting DRIVEs of its source and entity, because repeating an older one would undo
 * it. Returns its sequence, or 0 when COMMAND_CLIENT_WAITING_MAX wait. Does not block. */
uint64_t command_client_send(struct command_client *client, const jolon_Command *command);

/* Takes the replies that came and repeats the commands that are due. Does not block. */
void command_client_poll(struct command_client *client);

/* Returns true when the command was answered. The reply is copied, and the command forgotten. */
bool command_client_answered(struct command_client *client, uint64_t sequence,
                             jolon_CommandReply *reply);

/* Stops waiting for a command. It may still be executed. */
void command_client_forget(struct command_client *client, uint64_t sequence);

/* Returns when command_client_poll() has a command to repeat [CLOCK_MONOTONIC ns], UINT64_MAX when
 * none waits. */
uint64_t command_client_due_ns(const struct command_client *client);

/* Sends a command and waits for its reply, until until_ns (CLOCK_MONOTONIC) or a request to stop
 * (process_stopping()). Returns true with the reply. */
bool command_client_call(struct command_client *client, const jolon_Command *command,
                         uint64_t until_ns, jolon_CommandReply *reply);

/* Returns true if there is an intake that takes commands for this world. */
bool command_client_reachable(const struct command_client *client);

/* Returns a descriptor that is readable when command_client_poll() may have a reply to take, -1
 * when there is none now. */
int command_client_descriptor(const struct command_client *client);

/* Waits for a reply, the next repetition or until_ns (CLOCK_MONOTONIC). */
void command_client_wait(const struct command_client *client, uint64_t until_ns);

#endif
