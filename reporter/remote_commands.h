/* Remote commands: passes commands from DDS to the intake, as a local client would, and the replies
 * back to DDS. Only a reporter with --remote-commands does this.
 *
 * Each DDS writer has its own connection, so that the intake's budgets apply to each writer
 * separately. A command for which a connection has no room is dropped, and its sender repeats it.
 * One thread; does not block. */
#ifndef JOLON_REPORTER_REMOTE_COMMANDS_H
#define JOLON_REPORTER_REMOTE_COMMANDS_H

#include "ipc/topics/command_socket.h"
#include "ipc/topics/dds_topics.h"

#define REMOTE_SENDERS 12u /* fewer than CLIENTS_PER_PROCESS of the intake */

struct remote_commands {
    dds_entity_t reader, writer, waitset;
    const char *world;
    struct remote_sender {
        dds_instance_handle_t handle; /* of the DDS writer, 0: the entry is free */
        uint64_t heard_ns;
        struct command_socket socket;
        struct command_link link;
    } sender[REMOTE_SENDERS];
};

/* Makes the reader and the writer. Returns 0, or -1 with the reason. */
int remote_commands_open(struct remote_commands *remote, const char *world,
                         const struct dds_link *link, struct error_text *error);

/* Passes on the commands and the replies that have come. */
void remote_commands_poll(struct remote_commands *remote, uint64_t now_ns);

/* Waits for commands: at most busy_ns when a sender was heard lately, so that replies may come,
 * else at most idle_ns. */
void remote_commands_wait(const struct remote_commands *remote, uint64_t busy_ns, uint64_t idle_ns);

/* Writes into the reporter's slot whether the world takes remote commands without DDS Security. If
 * it does, the log warns. */
void remote_commands_tell(struct view *view, bool unguarded);

#endif
