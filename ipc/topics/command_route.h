/* The choice between the two links for commands, for client programs. Commands go to a world of
 * this user on this machine, or with --remote over DDS to a world on any machine. */
#ifndef JOLON_IPC_TOPICS_COMMAND_ROUTE_H
#define JOLON_IPC_TOPICS_COMMAND_ROUTE_H

#include "ipc/topics/command_client.h"
#include "ipc/topics/command_dds.h"
#include "ipc/topics/command_socket.h"

/* clang-format off */
/* The option that makes the choice, for a bool. */
#define COMMAND_ROUTE_OPTION_ROW(remote)                                                           \
    {"remote", NULL,                                                                               \
     "commands go over DDS, to a set elsewhere that takes such commands; else to your own world "  \
     "on this machine", .flag = &(remote)}
/* clang-format on */

struct command_route {
    struct command_socket socket;
    struct command_dds dds;
};

/* Opens the client: over the open DDS link if remote is true, else over the local socket (link is
 * then ignored). Returns 0, or -1 with the reason. */
int command_route_open(struct command_route *route, struct command_client *client, bool remote,
                       const struct dds_link *link, const char *world, struct error_text *error);

#endif
