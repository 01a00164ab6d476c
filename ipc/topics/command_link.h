/* The link that commands take to a world and replies take back, whatever carries them: the local
 * socket (command_socket.h) or DDS from another machine (command_dds.h). */
#ifndef JOLON_IPC_TOPICS_COMMAND_LINK_H
#define JOLON_IPC_TOPICS_COMMAND_LINK_H

#include "status.h"

#include <stdbool.h>

struct command_transport {
    /* Sends a command. What does not get out is lost: the caller repeats it. Does not block. */
    void (*send)(void *self, const jolon_Command *command);
    /* Takes a reply that has come; false when there is none. Does not block. */
    bool (*receive)(void *self, jolon_CommandReply *reply);
    /* True when somebody takes commands at the other end. */
    bool (*heard)(void *self);
    /* A descriptor that is readable when a reply may have come, -1 when there is none now. */
    int (*descriptor)(void *self);
};

struct command_link {
    const struct command_transport *transport;
    void *self;
};

#endif
