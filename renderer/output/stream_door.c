/* Where the stream listens. */
#include "renderer/output/stream_inside.h"

#include "ipc/clock.h"
#include "ipc/log.h"
#include "ipc/pictures.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define BACKLOG    64
#define SEND_BYTES (256 * 1024) /* of a client's socket: more only makes what it sees older */
#define TRIES      20           /* for a name whose last owner is just dying ... */
#define TRY_NS     10000000u    /* ... so long apart */

static void add_door(struct stream *stream, const struct http_listener *listener)
{
    CHECK(stream->doors < STREAM_DOORS);
    stream->door[stream->doors++] = (struct stream_door){.listener = *listener};
}

int stream_listen(struct stream *stream, const char *address, uint16_t port, struct reason *reason)
{
    struct http_listener listener;
    const struct http_listen_options options = {.address_option = "--stream-address",
                                                .port_option = "--stream",
                                                .address = address,
                                                .port = port,
                                                .send_bytes = SEND_BYTES};
    if (http_listen(&listener, &options, reason) != 0)
        return -1;
    snprintf(stream->url, sizeof stream->url, "%s", listener.url);
    if (!listener.local)
        log_warn("the stream is open to whoever reaches %s: it has no password", address);
    add_door(stream, &listener);
    return 0;
}

/* A listening socket of that name; -1 with errno. */
static int bind_here(const struct sockaddr_un *address, socklen_t length)
{
    const int bytes = SEND_BYTES;
    int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd < 0)
        return -1;
    if (setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes) == 0 &&
        bind(fd, (const struct sockaddr *)address, length) == 0 && listen(fd, BACKLOG) == 0)
        return fd;
    int cause = errno;
    close(fd);
    errno = cause;
    return -1;
}

/* The kernel gives a dead process's role away a moment before its sockets are gone. */
int stream_listen_here(struct stream *stream, enum role role, struct reason *reason)
{
    struct sockaddr_un address;
    socklen_t length = pictures_address(&address, stream->world, role);
    int fd = bind_here(&address, length);
    for (int i = 0; i < TRIES && fd < 0 && errno == EADDRINUSE; i++) {
        clock_sleep_until_ns(clock_now_ns() + TRY_NS);
        fd = bind_here(&address, length);
    }
    if (fd < 0)
        return reason_set(reason, "cannot listen on the socket @%s: %s", address.sun_path + 1,
                          errno == EADDRINUSE ? "another process has that name" : strerror(errno));
    const struct http_listener listener = {.fd = fd, .local = true, .ours = true};
    add_door(stream, &listener);
    return 0;
}
