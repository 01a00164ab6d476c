/* The stream's listening sockets. */
#ifndef JOLON_RENDERER_OUTPUT_STREAM_LISTEN_H
#define JOLON_RENDERER_OUTPUT_STREAM_LISTEN_H

#include "ipc/segment/role.h"
#include "ipc/segment/segment.h"

#include <stdint.h>

struct stream;

/* Binds and listens; port 0 takes any free port. Warns when other machines can connect. Returns 0,
 * or -1 with the reason: no such address, or the port is in use or not allowed. */
int stream_listen(struct stream *stream, const char *address, uint16_t port,
                  struct error_text *error);

/* Listens on the role's Unix socket (ipc/segment/picture_socket.h) for processes of the same user.
 * Returns 0, or -1 with the reason: another process has the name. */
int stream_listen_here(struct stream *stream, enum role role, struct error_text *error);

#endif
