/* Binding the stream's sockets. */
#include "renderer/output/stream_internal.h"

#include "ipc/process/log.h"
#include "ipc/segment/picture_socket.h"
#include "world/runtime/check.h"
#include "renderer/output/stream_listen.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define BACKLOG    64
#define SEND_BYTES (256 * 1024) /* of a client's socket: a larger buffer only delays pictures */

static void add_endpoint(struct stream *stream, const struct http_listener *listener)
{
    CHECK(stream->endpoints < STREAM_ENDPOINTS);
    stream->endpoint[stream->endpoints++] = (struct stream_endpoint){.listener = *listener};
}

int stream_listen(struct stream *stream, const char *address, uint16_t port,
                  struct error_text *error)
{
    struct http_listener listener;
    const struct http_listen_options options = {.address_option = "--stream-address",
                                                .port_option = "--stream",
                                                .address = address,
                                                .port = port,
                                                .send_bytes = SEND_BYTES};
    if (http_listen(&listener, &options, error) != 0)
        return -1;
    snprintf(stream->url, sizeof stream->url, "%s", listener.url);
    if (!listener.local)
        log_warn("the stream is open to every user who reaches %s: it has no password", address);
    add_endpoint(stream, &listener);
    return 0;
}

int stream_listen_here(struct stream *stream, enum role role, struct error_text *error)
{
    const int bytes = SEND_BYTES;
    char suffix[LOCAL_SOCKET_SUFFIX_MAX];
    picture_socket_suffix(suffix, role);
    int fd =
        local_socket_listen(stream->world, suffix, SOCK_STREAM | SOCK_NONBLOCK, BACKLOG, error);
    if (fd < 0)
        return -1;
    const struct http_listener listener = {.fd = fd, .local = true, .unix_socket = true};
    if (setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes) != 0) {
        error_text_set(error, "%s: cannot set the size of the socket's buffer: %s", suffix,
                       strerror(errno));
        close(fd);
        return -1;
    }
    add_endpoint(stream, &listener);
    return 0;
}
