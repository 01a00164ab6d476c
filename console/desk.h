/* The desk: orders go out as commands, over the world's command socket, and replies come back.
 * Requests leave tickets from the server's thread; the desk's own thread sends, repeats and
 * answers, so that each order is done once whatever dies meanwhile.
 *
 * Who drives is held for DESK_LEASE_S of simulation, renewed while the player's page goes on asking
 * (console/players.h): a page that goes away, a console that dies, loses its vehicle in two
 * seconds. Everything but desk_wait() is under the console's lock. */
#ifndef JOLON_CONSOLE_DESK_H
#define JOLON_CONSOLE_DESK_H

#include "console/body.h"
#include "console/watch.h"
#include "topics/caller.h"
#include "topics/command_socket.h"
#include "topics/mission.h"

#define DESK_TICKETS  128u /* orders that wait, in all */
#define DESK_MISSIONS 8u   /* that run at a time */
#define DESK_REPLY_NS 3000000000u
#define DESK_RENEW_NS 150000000u
#define DESK_LEASE_S  1.0

struct ticket {
    struct ticket *next;
    struct order order;
    uint32_t cancel; /* the mission to call off, 0: it is an order */
    uint32_t player; /* its number, 0: none */
    uint64_t source;
    uint64_t sequence; /* 0: not sent yet; of a drive: the version of the
                          controls; of a mission: its number */
    uint64_t until_ns;
    struct answer answer; /* when it is done */
    bool done;
    void (*ready)(struct ticket *ticket); /* called once, when it is done */
};

/* Its rounds are due in simulated time. */
struct desk_mission {
    uint32_t number; /* 1, 2, ...; 0: the place is free */
    struct mission mission;
};

struct desk {
    struct command_socket socket; /* of the caller */
    struct caller caller;
    struct names names;
    int bell;              /* an eventfd that wakes the desk's thread */
    struct ticket *ticket; /* those that wait, the oldest first */
    uint32_t tickets;
    struct desk_mission mission[DESK_MISSIONS];
    uint32_t missions; /* ever */
};

/* 0, or -1 with the reason. */
int desk_open(struct desk *desk, const char *world, struct reason *reason);
/* Answers those that wait, too. */
void desk_close(struct desk *desk);

/* Takes an order, whose ticket is the desk's until ready is called; player NULL: in the console's
 * own name. False with the answer when it can be told at once that it will not do. */
bool desk_put(struct desk *desk, struct ticket *ticket, struct player *player, uint64_t now_ns,
              struct answer *answer);

/* Sends what is to be sent and answers what can be answered. */
void desk_turn(struct desk *desk, struct players *players, const struct watch *watch,
               uint64_t now_ns);

/* The world is another one, or gone: nobody drives in it. Reads the names of its vehicles. */
void desk_world_changed(struct desk *desk, struct players *players, const struct watch *watch);

/* Waits for a ticket, a reply, or until_ns (CLOCK_MONOTONIC). */
void desk_wait(struct desk *desk, uint64_t until_ns);

#endif
