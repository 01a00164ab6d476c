/* Local socket or DDS. */
#include "ipc/topics/command_route.h"

int command_route_open(struct command_route *route, struct command_client *client, bool remote,
                       const struct dds_link *link, const char *world, struct error_text *error)
{
    struct command_link chosen;
    if (!remote)
        chosen = command_socket_open(&route->socket, world);
    else if (command_dds_open(&route->dds, link, &chosen, error) != 0)
        return -1;
    return command_client_open(client, chosen, error);
}
