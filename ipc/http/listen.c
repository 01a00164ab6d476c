/* Listening sockets of IPv4 and IPv6. */
#include "ipc/http/listen.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define BACKLOG 512 /* a full backlog delays a client by a second */

union socket_address {
    struct sockaddr any;
    struct sockaddr_in four;
    struct sockaddr_in6 six;
};

/* Returns the length of the socket address, 0 when the text is no IPv4 or IPv6 address. */
static socklen_t parse_address(union socket_address *address, const char *text, uint16_t port)
{
    address->four = (struct sockaddr_in){.sin_family = AF_INET, .sin_port = htons(port)};
    if (inet_pton(AF_INET, text, &address->four.sin_addr) == 1)
        return sizeof address->four;
    address->six = (struct sockaddr_in6){.sin6_family = AF_INET6, .sin6_port = htons(port)};
    return inet_pton(AF_INET6, text, &address->six.sin6_addr) == 1 ? sizeof address->six : 0;
}

static int bind_to(const union socket_address *address, socklen_t length, int send_bytes)
{
    const int one = 1;
    int fd = socket(address->any.sa_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd < 0)
        return -1;
    /* So that a restarted process gets the port of its predecessor. */
    if (setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one) == 0 &&
        (send_bytes == 0 ||
         setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &send_bytes, sizeof send_bytes) == 0) &&
        bind(fd, &address->any, length) == 0 && listen(fd, BACKLOG) == 0)
        return fd;
    int cause = errno;
    close(fd);
    errno = cause;
    return -1;
}

static void write_url(struct http_listener *listener, const union socket_address *address)
{
    char text[INET6_ADDRSTRLEN];
    if (address->any.sa_family == AF_INET)
        snprintf(listener->url, sizeof listener->url, "http://%s:%u/",
                 inet_ntop(AF_INET, &address->four.sin_addr, text, sizeof text),
                 ntohs(address->four.sin_port));
    else
        snprintf(listener->url, sizeof listener->url, "http://[%s]:%u/",
                 inet_ntop(AF_INET6, &address->six.sin6_addr, text, sizeof text),
                 ntohs(address->six.sin6_port));
}

static bool is_loopback(const union socket_address *address)
{
    return address->any.sa_family == AF_INET
               ? ntohl(address->four.sin_addr.s_addr) >> 24 == IN_LOOPBACKNET
               : IN6_IS_ADDR_LOOPBACK(&address->six.sin6_addr);
}

int http_listen(struct http_listener *listener, const struct http_listen_options *options,
                struct error_text *error)
{
    union socket_address address;
    socklen_t length = parse_address(&address, options->address, options->port);
    *listener = (struct http_listener){.fd = -1};
    if (length == 0)
        return error_text_set(error, "%s %s: must be an address, as 127.0.0.1 or ::1",
                              options->address_option, options->address);
    listener->fd = bind_to(&address, length, options->send_bytes);
    if (listener->fd >= 0 && getsockname(listener->fd, &address.any, &length) == 0) {
        listener->local = is_loopback(&address);
        write_url(listener, &address);
        return 0;
    }
    int cause = errno;
    if (listener->fd >= 0)
        close(listener->fd);
    listener->fd = -1;
    return error_text_set(error, "%s %u: cannot listen on %s port %u: %s", options->port_option,
                          options->port, options->address, options->port,
                          cause == EADDRINUSE ? "it is in use; name another" : strerror(cause));
}
