/* The console's HTTP server, in the thread of ipc/http/server.h. It answers at once from the copy
 * of the world; the answer to a command waits for its result without blocking the thread. Every
 * request is checked before it has an effect: docs/console.md, "Security". */
#ifndef JOLON_CLIENTS_CONSOLE_SERVER_H
#define JOLON_CLIENTS_CONSOLE_SERVER_H

#include "clients/console/command_queue.h"
#include "clients/console/picture_proxy.h"
#include "clients/console/players.h"
#include "clients/console/session_key.h"
#include "clients/console/world_reader.h"
#include "ipc/http/server.h"

#include <pthread.h>

struct console {
    pthread_mutex_t lock; /* of all members below but the constant ones */
    struct world_reader reader;
    struct players players;
    struct rate write_rate; /* of changing requests without a player's key */
    struct command_queue queue;
    struct picture_proxy proxy; /* has a lock of its own */
    bool ending;                /* no commands are accepted any more */
    /* Constant while the server runs. */
    char token[SESSION_KEY_MAX];
    struct http_listener listener;
    struct http_server *http;
};

/* Starts the server on the listener, which it then owns. Returns 0, or -1 with the error. */
int server_start(struct console *console, struct error_text *error);

/* Ends all connections and the thread. */
void server_end(struct console *console);

#endif
