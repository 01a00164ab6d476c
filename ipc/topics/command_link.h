/* The link that carries commands to a world and replies back: the local socket (command_socket.h),
 * or DDS from another machine (command_dds.h). */
#ifndef JOLON_IPC_TOPICS_COMMAND_LINK_H
#define JOLON_IPC_TOPICS_COMMAND_LINK_H

#include "status.h"

#include <stdbool.h>

struct command_transport {
    /* Sends a command. It may be lost; the caller repeats it. Does not block. */
    void (*send)(void *self, const jolon_Command *command);
    /* Takes a reply that has come. Returns false when there is none. Does not block. */
    bool (*receive)(void *self, jolon_CommandReply *reply);
    /* Returns true when a process at the other end takes commands. */
    bool (*reachable)(void *self);
    /* Returns a descriptor that is readable when a reply may have come, -1 when there is none
     * now. */
    int (*descriptor)(void *self);
};

struct command_link {
    const struct command_transport *transport;
    void *self;
};

#endif
