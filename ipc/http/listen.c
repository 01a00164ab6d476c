/* Sockets, IPv4 and IPv6. */
#include "ipc/http/listen.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define BACKLOG 512 /* one that is full costs a client a second */

static int bind_to(int family, const struct sockaddr *address, socklen_t length, int send_bytes)
{
    const int one = 1;
    int fd = socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd < 0)
        return -1;
    /* The port of a process that has just died is ours again. */
    if (setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one) == 0 &&
        (send_bytes == 0 ||
         setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &send_bytes, sizeof send_bytes) == 0) &&
        bind(fd, address, length) == 0 && listen(fd, BACKLOG) == 0)
        return fd;
    int cause = errno;
    close(fd);
    errno = cause;
    return -1;
}

static int listen_four(struct http_listener *listener, const struct in_addr *address,
                       const struct http_listen_options *options)
{
    struct sockaddr_in socket_address = {
        .sin_family = AF_INET, .sin_addr = *address, .sin_port = htons(options->port)};
    socklen_t length = sizeof socket_address;
    char text[INET_ADDRSTRLEN];
    listener->fd =
        bind_to(AF_INET, (struct sockaddr *)&socket_address, length, options->send_bytes);
    if (listener->fd < 0 ||
        getsockname(listener->fd, (struct sockaddr *)&socket_address, &length) != 0)
        return -1;
    listener->local = ntohl(address->s_addr) >> 24 == IN_LOOPBACKNET;
    snprintf(listener->url, sizeof listener->url, "http://%s:%u/",
             inet_ntop(AF_INET, address, text, sizeof text), ntohs(socket_address.sin_port));
    return 0;
}

static int listen_six(struct http_listener *listener, const struct in6_addr *address,
                      const struct http_listen_options *options)
{
    struct sockaddr_in6 socket_address = {
        .sin6_family = AF_INET6, .sin6_addr = *address, .sin6_port = htons(options->port)};
    socklen_t length = sizeof socket_address;
    char text[INET6_ADDRSTRLEN];
    listener->fd =
        bind_to(AF_INET6, (struct sockaddr *)&socket_address, length, options->send_bytes);
    if (listener->fd < 0 ||
        getsockname(listener->fd, (struct sockaddr *)&socket_address, &length) != 0)
        return -1;
    listener->local = IN6_IS_ADDR_LOOPBACK(address);
    snprintf(listener->url, sizeof listener->url, "http://[%s]:%u/",
             inet_ntop(AF_INET6, address, text, sizeof text), ntohs(socket_address.sin6_port));
    return 0;
}

int http_listen(struct http_listener *listener, const struct http_listen_options *options,
                struct error_text *error)
{
    struct in_addr four;
    struct in6_addr six;
    int result;
    *listener = (struct http_listener){.fd = -1};
    if (inet_pton(AF_INET, options->address, &four) == 1)
        result = listen_four(listener, &four, options);
    else if (inet_pton(AF_INET6, options->address, &six) == 1)
        result = listen_six(listener, &six, options);
    else
        return error_text_set(error, "%s %s: must be an address, as 127.0.0.1 or ::1",
                              options->address_option, options->address);
    if (result == 0)
        return 0;
    int cause = errno;
    if (listener->fd >= 0)
        close(listener->fd);
    listener->fd = -1;
    return error_text_set(error, "%s %u: cannot listen on %s port %u: %s", options->port_option,
                          options->port, options->address, options->port,
                          cause == EADDRINUSE ? "it is in use; name another" : strerror(cause));
}
