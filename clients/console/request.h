/* A request under way, as the server's parts share it. */
#ifndef JOLON_CLIENTS_CONSOLE_REQUEST_H
#define JOLON_CLIENTS_CONSOLE_REQUEST_H

#include "clients/console/server.h"

#include <stddef.h>

#define REQUEST_BODY 4096u /* [byte] of a body at most */

/* The request's own room in the server (ipc/http/server.h). */
struct request {
    struct console *console;
    struct http_request *http;
    struct pending_command pending; /* of its order; its answer comes when that is done */
    struct picture_waiter waiter;   /* of the picture that it wants */
};

#endif
