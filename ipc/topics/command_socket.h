/* The local link for commands: the command socket of a world of this user, on this machine.
 *
 * It connects when there is a command to send, and connects again when the other end was restarted.
 * One thread. */
#ifndef JOLON_IPC_TOPICS_COMMAND_SOCKET_H
#define JOLON_IPC_TOPICS_COMMAND_SOCKET_H

#include "ipc/topics/command_link.h"

#include <stdint.h>

struct command_socket {
    const char *world;
    int fd; /* -1: not connected */
    uint64_t tried_ns;
};

/* Prepares the link. The world need not exist yet. */
struct command_link command_socket_open(struct command_socket *socket, const char *world);
void command_socket_close(struct command_socket *socket);

#endif
