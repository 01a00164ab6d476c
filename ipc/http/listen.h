/* The socket that an HTTP server listens on. */
#ifndef JOLON_IPC_HTTP_LISTEN_H
#define JOLON_IPC_HTTP_LISTEN_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stdint.h>

#define HTTP_LISTEN_ADDRESS "127.0.0.1" /* by default; others can be told */

struct http_listener {
    int fd;       /* non-blocking, listening; the owner's to close */
    bool local;   /* only this machine can reach it */
    bool ours;    /* a Unix socket, for processes of this user (geteuid()) alone */
    char url[96]; /* "http://ADDRESS:PORT/" */
};

/* How the command line calls what can be wrong with it. */
struct http_listen_options {
    const char *address_option, *port_option;
    const char *address; /* IPv4 or IPv6 */
    uint16_t port;       /* 0: any that is free */
    int send_bytes;      /* of a client's socket, 0: as the system has it */
};

/* Binds and listens. 0, or -1 with the reason: no such address, the port is in use or not allowed.
 */
int http_listen(struct http_listener *listener, const struct http_listen_options *options,
                struct error_text *error);

#endif
