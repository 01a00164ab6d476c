/* The connections of an HTTP server: which connection is shut so that a new one gets its slot, and
 * which have exceeded their time. Loopback clients all have one address, so a connection is judged
 * by its progress: it sends a whole request, or it takes a part of an answer. These functions shut
 * sockets and never close them. The caller holds the server's lock. */
#ifndef JOLON_IPC_HTTP_CONNECTION_LIMIT_H
#define JOLON_IPC_HTTP_CONNECTION_LIMIT_H

#include "ipc/process/rate.h"

#include <stdbool.h>
#include <stdint.h>

/* When all slots are taken, one connection is shut for each new one. The room includes connections
 * that are being shut. */
#define CONNECTION_SLOTS_MAX   256u
#define CONNECTION_ROOM(slots) ((slots) + (slots) / 4)
#define CONNECTION_ROOM_MAX    CONNECTION_ROOM(CONNECTION_SLOTS_MAX)

#define CONNECTION_ASKING_NS    10000000000u /* to send a whole request */
#define CONNECTION_ANSWERING_NS 30000000000u /* to take a part of an answer */

enum connection_state {
    CONNECTION_ASKING,    /* its next request is not whole yet */
    CONNECTION_WAITING,   /* the server keeps it waiting */
    CONNECTION_ANSWERING, /* it has a part of an answer to take */
};

struct connection {
    int fd;
    bool taken, ending;
    bool asked; /* it has sent a whole request */
    enum connection_state state;
    uint64_t since_ns; /* CLOCK_MONOTONIC of its last progress */
    struct rate rate;  /* of its requests */
};

struct connection_limit {
    struct connection connection[CONNECTION_ROOM_MAX];
    uint32_t slots, taken; /* slots: at most CONNECTION_SLOTS_MAX, set by the owner */
};

/* Gives a new connection a slot. When all slots are taken, the connection without progress for
 * longest is shut. While connections that have never asked hold more than half of the slots, only
 * those are shut. So connections that are being served keep their slots, and a new one has time to
 * ask. A connection that waits for the server is never shut. Returns NULL when there is no room. */
struct connection *connection_come(struct connection_limit *limit, int fd, uint64_t now_ns);
void connection_leave(struct connection_limit *limit, struct connection *connection);

/* Notes progress of the connection, or that it waits for the server from now on. */
void connection_note(struct connection *connection, enum connection_state state, uint64_t now_ns);

/* Returns true if the client has taken nothing of its answer for stall_ns. */
bool connection_stalls(const struct connection *connection, uint64_t stall_ns, uint64_t now_ns);

/* Shuts the connection. Its owner then finds it closed, and calls connection_leave(). */
void connection_shut(struct connection *connection);

/* Shuts the connections that have exceeded their time. */
void connection_sweep(struct connection_limit *limit, uint64_t now_ns);

#endif
