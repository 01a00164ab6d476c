/* A request under way, as the server's parts share it. */
#ifndef JOLON_CONSOLE_REQUEST_H
#define JOLON_CONSOLE_REQUEST_H

#include "console/server.h"

#include <stddef.h>

#define REQUEST_BODY 4096u /* [byte] of a body at most */

struct MHD_Connection;

struct request {
    struct console *console;
    struct MHD_Connection *connection;
    struct seat *seat;    /* NULL: there was no room */
    struct ticket ticket; /* of its order; its answer comes when that is done */
    struct gaze gaze;     /* of the picture that it wants */
    char body[REQUEST_BODY];
    size_t body_bytes; /* beyond REQUEST_BODY: it was longer, and is not whole */
};

/* A header's value, NULL when the request has none. */
const char *request_header(const struct request *request, const char *name);

#endif
