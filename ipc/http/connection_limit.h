/* The connections of a server: which one has to go so that another gets in, and which are out of
 * time. Loopback clients all have one address, so a connection is judged by its progress: it sends
 * a whole request, or it takes a part of an answer. It shuts sockets, and closes none. The caller
 * has the lock. */
#ifndef JOLON_IPC_HTTP_CONNECTION_LIMIT_H
#define JOLON_IPC_HTTP_CONNECTION_LIMIT_H

#include "ipc/process/rate.h"

#include <stdbool.h>
#include <stdint.h>

#define CONNECTION_SEATS_MAX   256u                    /* beyond it one goes for each that comes */
#define CONNECTION_ROOM(seats) ((seats) + (seats) / 4) /* with those on their way out */
#define CONNECTION_ROOM_MAX    CONNECTION_ROOM(CONNECTION_SEATS_MAX)

#define CONNECTION_ASKING_NS    10000000000u /* for a whole request */
#define CONNECTION_ANSWERING_NS 30000000000u /* for a part of an answer */

enum connection_state {
    CONNECTION_ASKING,    /* no whole request is there */
    CONNECTION_WAITING,   /* the server keeps it waiting */
    CONNECTION_ANSWERING, /* it is to take a part of an answer */
};

struct connection {
    int fd;
    bool taken, ending;
    bool asked; /* a whole request has come, now or before */
    enum connection_state state;
    uint64_t since_ns; /* of its last progress */
    struct rate rate;  /* of its requests */
};

struct connection_limit {
    struct connection connection[CONNECTION_ROOM_MAX];
    uint32_t seats, taken; /* seats: at most CONNECTION_SEATS_MAX; set by the owner */
};

/* A connection came. When all seats are taken another one is shut: the one without progress for
 * longest, only among those that have not asked anything while these have more than half of the
 * seats. So connections that are served keep theirs, and a new one has time to ask. One that the
 * server keeps waiting stays. NULL when there is no room. */
struct connection *connection_come(struct connection_limit *limit, int fd, uint64_t now_ns);
void connection_leave(struct connection_limit *limit, struct connection *connection);

/* It has made progress, or is kept waiting from now on. */
void connection_note(struct connection *connection, enum connection_state state, uint64_t now_ns);

/* Has it taken nothing of its answer for so long? */
bool connection_stalls(const struct connection *connection, uint64_t stall_ns, uint64_t now_ns);

/* Its owner then finds it closed, and says that it left. */
void connection_shut(struct connection *connection);

/* Shuts those that are out of time. */
void connection_sweep(struct connection_limit *limit, uint64_t now_ns);

#endif
