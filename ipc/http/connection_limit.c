/* Chooses the connection that is shut when a new one comes. */
#include "ipc/http/connection_limit.h"

#include <stddef.h>
#include <sys/socket.h>

void connection_shut(struct connection *connection)
{
    connection->ending = true;
    (void)shutdown(connection->fd, SHUT_RDWR);
}

static bool is_newcomer(const struct connection *connection)
{
    return connection->taken && !connection->ending && !connection->asked;
}

static struct connection *slowest(struct connection_limit *limit)
{
    struct connection *found = NULL;
    uint32_t newcomers = 0, room = CONNECTION_ROOM(limit->slots);
    for (uint32_t i = 0; i < room; i++)
        newcomers += is_newcomer(&limit->connection[i]) ? 1 : 0;
    for (uint32_t i = 0; i < room; i++) {
        struct connection *connection = &limit->connection[i];
        if (!connection->taken || connection->ending || connection->state == CONNECTION_WAITING ||
            (newcomers > limit->slots / 2 && connection->asked))
            continue;
        if (!found || connection->since_ns < found->since_ns)
            found = connection;
    }
    return found;
}

struct connection *connection_come(struct connection_limit *limit, int fd, uint64_t now_ns)
{
    for (uint32_t i = 0; i < CONNECTION_ROOM(limit->slots); i++) {
        struct connection *connection = &limit->connection[i];
        if (connection->taken)
            continue;
        struct connection *leaver = limit->taken >= limit->slots ? slowest(limit) : NULL;
        if (leaver)
            connection_shut(leaver);
        *connection = (struct connection){.fd = fd, .taken = true, .since_ns = now_ns};
        limit->taken++;
        return connection;
    }
    return NULL;
}

void connection_leave(struct connection_limit *limit, struct connection *connection)
{
    connection->taken = false;
    limit->taken--;
}

void connection_note(struct connection *connection, enum connection_state state, uint64_t now_ns)
{
    connection->asked |= state != CONNECTION_ASKING;
    connection->state = state;
    connection->since_ns = now_ns;
}

bool connection_stalls(const struct connection *connection, uint64_t stall_ns, uint64_t now_ns)
{
    return connection->state == CONNECTION_ANSWERING && now_ns > connection->since_ns + stall_ns;
}

void connection_sweep(struct connection_limit *limit, uint64_t now_ns)
{
    for (uint32_t i = 0; i < CONNECTION_ROOM(limit->slots); i++) {
        struct connection *connection = &limit->connection[i];
        if (!connection->taken || connection->ending)
            continue;
        if (connection_stalls(connection, CONNECTION_ANSWERING_NS, now_ns) ||
            (connection->state == CONNECTION_ASKING &&
             now_ns > connection->since_ns + CONNECTION_ASKING_NS))
            connection_shut(connection);
    }
}
