/* Remote commands: what comes over DDS goes to the intake as a local client's commands do, and the
 * replies go back over DDS. Only a reporter that was started with --remote-commands does it.
 *
 * Each DDS writer has a connection of its own, so that the intake's budgets and turns hold for each
 * of them alone. A command for which a connection has no room is dropped; its sender repeats it.
 * One thread; nothing blocks. */
#ifndef JOLON_REPORTER_REMOTE_COMMANDS_H
#define JOLON_REPORTER_REMOTE_COMMANDS_H

#include "ipc/topics/command_socket.h"
#include "ipc/topics/dds_topics.h"

#define REMOTE_SENDERS 12u /* fewer than CLIENTS_PER_PROCESS of the intake */

struct remote_commands {
    dds_entity_t reader, writer, waitset;
    const char *world;
    struct remote_sender {
        dds_instance_handle_t handle; /* of the DDS writer, 0: the place is free */
        uint64_t heard_ns;
        struct command_socket socket;
        struct command_link link;
    } sender[REMOTE_SENDERS];
};

/* Makes the reader and the writer; -1 with the reason. */
int remote_commands_open(struct remote_commands *remote, const char *world,
                         const struct dds_link *link, struct error_text *error);

/* Passes on the commands and the replies that have come. */
void remote_commands_poll(struct remote_commands *remote, uint64_t now_ns);

/* Waits for commands: at most busy_ns when a sender was heard lately, so that replies are to be
 * expected, else at most idle_ns. */
void remote_commands_wait(const struct remote_commands *remote, uint64_t busy_ns, uint64_t idle_ns);

/* Notes in the reporter's slot whether the world takes remote commands without DDS Security. If it
 * does, the log warns of it. */
void remote_commands_tell(struct view *view, bool unguarded);

#endif
