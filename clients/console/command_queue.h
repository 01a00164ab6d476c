/* The desk: orders go out as commands, over the world's command socket, and replies come back.
 * Requests leave tickets from the server's thread; the desk's own thread sends, repeats and
 * answers, so that each order is done once whatever dies meanwhile.
 *
 * Who drives is held for COMMAND_QUEUE_LEASE_S of simulation, renewed while the player's page goes
 * on asking (clients/console/players.h): a page that goes away, a console that dies, loses its
 * vehicle in two seconds. Everything but command_queue_wait() is under the console's lock. */
#ifndef JOLON_CLIENTS_CONSOLE_COMMAND_QUEUE_H
#define JOLON_CLIENTS_CONSOLE_COMMAND_QUEUE_H

#include "clients/console/request_body.h"
#include "clients/console/world_reader.h"
#include "ipc/topics/command_client.h"
#include "ipc/topics/command_socket.h"
#include "ipc/topics/command_series.h"

#define COMMAND_QUEUE_TICKETS  128u /* orders that wait, in all */
#define COMMAND_QUEUE_MISSIONS 8u   /* that run at a time */
#define COMMAND_QUEUE_REPLY_NS 3000000000u
#define COMMAND_QUEUE_RENEW_NS 150000000u
#define COMMAND_QUEUE_LEASE_S  1.0

struct pending_command {
    struct pending_command *next;
    struct command_text order;
    uint32_t cancel; /* the mission to call off, 0: it is an order */
    uint32_t player; /* its number, 0: none */
    uint64_t source;
    uint64_t sequence; /* 0: not sent yet; of a drive: the version of the
                          controls; of a mission: its number */
    uint64_t until_ns;
    struct http_answer answer; /* when it is done */
    bool done;
    void (*ready)(struct pending_command *ticket); /* called once, when it is done */
};

/* Its rounds are due in simulated time. */
struct command_queue_mission {
    uint32_t number; /* 1, 2, ...; 0: the place is free */
    struct command_series mission;
};

struct command_queue {
    struct command_socket socket; /* of the caller */
    struct command_client caller;
    struct name_table names;
    int bell;                       /* an eventfd that wakes the desk's thread */
    struct pending_command *ticket; /* those that wait, the oldest first */
    uint32_t tickets;
    struct command_queue_mission mission[COMMAND_QUEUE_MISSIONS];
    uint32_t missions; /* ever */
};

/* 0, or -1 with the reason. */
int command_queue_open(struct command_queue *desk, const char *world, struct reason *reason);
/* Answers those that wait, too. */
void command_queue_close(struct command_queue *desk);

/* Takes an order, whose ticket is the desk's until ready is called; player NULL: in the console's
 * own name. False with the answer when it can be told at once that it will not do. */
bool command_queue_put(struct command_queue *desk, struct pending_command *ticket,
                       struct player *player, uint64_t now_ns, struct http_answer *answer);

/* Sends what is to be sent and answers what can be answered. */
void command_queue_turn(struct command_queue *desk, struct players *players,
                        const struct world_reader *watch, uint64_t now_ns);

/* The world is another one, or gone: nobody drives in it. Reads the names of its vehicles. */
void command_queue_world_changed(struct command_queue *desk, struct players *players,
                                 const struct world_reader *watch);

/* Waits for a ticket, a reply, or until_ns (CLOCK_MONOTONIC). */
void command_queue_wait(struct command_queue *desk, uint64_t until_ns);

#endif
