/* The server: people's browsers, in the thread of ipc/http/server.h. It answers from the
 * world's copy at once; a command's answer waits, without the thread, for what became of it. Every
 * request is checked before anything is done: docs/console.md, "Security". */
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
    pthread_mutex_t lock; /* of all below but what never changes */
    struct world_reader reader;
    struct players players;
    struct rate write_rate; /* of those who change the world without a player's name */
    struct command_queue queue;
    struct picture_proxy proxy; /* has a lock of its own */
    bool ending;                /* no order is taken any more */
    /* What never changes once the server runs. */
    char token[SESSION_KEY_MAX];
    struct http_listener listener;
    struct http_server *http;
};

/* Starts to serve on the listener, which becomes the server's. 0, or -1 with the reason. */
int server_start(struct console *console, struct error_text *error);

/* Ends all connections and the thread. */
void server_end(struct console *console);

#endif
