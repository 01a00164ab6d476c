/* A request in progress, which the parts of the server share. */
#ifndef JOLON_CLIENTS_CONSOLE_REQUEST_H
#define JOLON_CLIENTS_CONSOLE_REQUEST_H

#include "clients/console/server.h"

#include <stddef.h>

#define REQUEST_BODY 4096u /* [byte] longest body */

/* The request's memory in the server (own_bytes of ipc/http/server.h). */
struct request {
    struct console *console;
    struct http_request *http;
    struct pending_command pending; /* its command, whose answer comes when it is done */
    struct picture_waiter waiter;   /* its picture */
};

#endif
