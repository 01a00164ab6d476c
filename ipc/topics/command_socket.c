/* Commands over the world's command socket. */
#include "ipc/topics/command_socket.h"

#include "ipc/process/clock.h"
#include "ipc/segment/local_socket.h"
#include "ipc/segment/segment.h"
#include "ipc/topics/command_packet.h"

#include <errno.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define RETRY_NS (10 * (uint64_t)NS_PER_MS) /* between two tries to connect */

static bool connected(struct command_socket *socket)
{
    struct error_text error;
    uint64_t now_ns = clock_now_ns();
    if (socket->fd >= 0)
        return true;
    if (socket->tried_ns && now_ns - socket->tried_ns < RETRY_NS)
        return false;
    socket->tried_ns = now_ns;
    socket->fd = local_socket_connect(socket->world, COMMAND_SOCKET_SUFFIX,
                                      SOCK_SEQPACKET | SOCK_NONBLOCK, &error);
    return socket->fd >= 0;
}

static void disconnect(struct command_socket *socket)
{
    close(socket->fd);
    socket->fd = -1;
}

static bool reachable(void *self)
{
    return connected(self);
}

static void send_command(void *self, const jolon_Command *command)
{
    struct command_socket *socket = self;
    struct command_packet packet;
    memset(&packet, 0, sizeof packet); /* the padding goes out too */
    packet.magic = COMMAND_PACKET_MAGIC;
    packet.version = COMMAND_PACKET_VERSION;
    packet.command = *command;
    /* The second try is over a new connection, as the first connection's other end may have
     * died. */
    for (int i = 0; i < 2 && connected(socket); i++) {
        if (send(socket->fd, &packet, sizeof packet, MSG_DONTWAIT | MSG_NOSIGNAL) >= 0 ||
            errno == EAGAIN || errno == ENOBUFS)
            return;
        disconnect(socket);
    }
}

static bool receive(void *self, jolon_CommandReply *reply)
{
    struct command_socket *socket = self;
    struct reply_packet packet;
    if (socket->fd < 0)
        return false;
    ssize_t bytes = recv(socket->fd, &packet, sizeof packet, MSG_DONTWAIT | MSG_TRUNC);
    if (bytes < 0 && (errno == EAGAIN || errno == EINTR))
        return false;
    if (bytes != (ssize_t)sizeof packet || packet.magic != COMMAND_PACKET_MAGIC ||
        packet.version != COMMAND_PACKET_VERSION) {
        disconnect(socket); /* the other end has ended, or is of another build */
        return false;
    }
    *reply = packet.reply;
    return true;
}

static int descriptor(void *self)
{
    const struct command_socket *socket = self;
    return socket->fd;
}

struct command_link command_socket_open(struct command_socket *socket, const char *world)
{
    static const struct command_transport transport = {send_command, receive, reachable,
                                                       descriptor};
    *socket = (struct command_socket){.world = world, .fd = -1};
    /* Connect now: the first search for the runtime folder needs more than a sandbox allows. */
    (void)connected(socket);
    return (struct command_link){&transport, socket};
}

void command_socket_close(struct command_socket *socket)
{
    if (socket->fd >= 0)
        disconnect(socket);
}
