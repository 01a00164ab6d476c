/* The socket that an HTTP server listens on. */
#ifndef JOLON_IPC_HTTP_LISTEN_H
#define JOLON_IPC_HTTP_LISTEN_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stdint.h>

#define HTTP_LISTEN_ADDRESS "127.0.0.1" /* the default */

struct http_listener {
    int fd;           /* non-blocking, listening; the owner closes it */
    bool local;       /* only this machine can reach it */
    bool unix_socket; /* a Unix socket, for processes of this user (geteuid()) only */
    char url[96];     /* "http://ADDRESS:PORT/" */
};

/* What to listen on. address_option and port_option name the options in error texts. */
struct http_listen_options {
    const char *address_option, *port_option;
    const char *address; /* IPv4 or IPv6 */
    uint16_t port;       /* 0: any free port */
    int send_bytes;      /* send buffer of a client's socket, 0: the system's default */
};

/* Binds and listens. Returns 0, or -1 with the reason: the address does not exist, or the port is
 * in use or not allowed. */
int http_listen(struct http_listener *listener, const struct http_listen_options *options,
                struct error_text *error);

#endif
