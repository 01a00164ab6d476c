/* The choice between the two links for commands, for programs that people call. Commands go to a
 * world of this user on this machine, or with --remote over DDS to a world anywhere. */
#ifndef JOLON_IPC_TOPICS_COMMAND_ROUTE_H
#define JOLON_IPC_TOPICS_COMMAND_ROUTE_H

#include "ipc/topics/command_client.h"
#include "ipc/topics/command_dds.h"
#include "ipc/topics/command_socket.h"

/* The option --remote, for getopt_long; its value is COMMAND_ROUTE_OPTION. */
#define COMMAND_ROUTE_OPTION (DDS_LINK_OPTION_FIRST + 100)
#define COMMAND_ROUTE_LONG_OPTION                                                                  \
    {                                                                                              \
        "remote", no_argument, NULL, COMMAND_ROUTE_OPTION                                          \
    }

struct command_route {
    struct command_socket socket;
    struct command_dds dds;
};

/* Opens the caller's link: over the open DDS link if remote is true, else over the local socket,
 * for which link is not looked at. 0, or -1 with the reason. */
int command_route_open(struct command_route *route, struct command_client *caller, bool remote,
                       const struct dds_link *link, const char *world, struct reason *reason);

#endif
