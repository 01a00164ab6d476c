/* Sends the players' commands over the world's command socket and reads the replies. The server's
 * thread appends pending commands. The console's main thread sends them, repeats them and writes
 * the answers, so that each command is done once although a process may die meanwhile.
 *
 * A player holds a vehicle by a lease of COMMAND_QUEUE_LEASE_S of simulated time. The lease is
 * renewed while the player's page sends requests (clients/console/players.h). When the page is
 * closed or the console dies, the vehicle returns to its agent after at most two seconds. All
 * functions but command_queue_wait() are called under the console's lock. */
#ifndef JOLON_CLIENTS_CONSOLE_COMMAND_QUEUE_H
#define JOLON_CLIENTS_CONSOLE_COMMAND_QUEUE_H

#include "clients/console/request_body.h"
#include "clients/console/world_reader.h"
#include "ipc/topics/command_client.h"
#include "ipc/topics/command_socket.h"
#include "ipc/topics/command_series.h"

#define COMMAND_QUEUE_PENDING_MAX 128u /* commands that wait, in all */
#define COMMAND_QUEUE_MISSIONS    8u   /* fire missions at a time */
#define COMMAND_QUEUE_REPLY_NS    3000000000u
#define COMMAND_QUEUE_RENEW_NS    150000000u
#define COMMAND_QUEUE_LEASE_S     1.0

struct pending_command {
    struct pending_command *next;
    struct command_text order;
    uint32_t cancel; /* number of the fire mission to cancel, 0: a command */
    uint32_t player; /* its number, 0: none */
    uint64_t source;
    uint64_t sequence; /* 0: not sent yet; of a drive: the version of the controls; of a fire
                          mission: its number */
    uint64_t until_ns;
    struct http_answer answer; /* set when done */
    bool done;
    void (*ready)(struct pending_command *pending); /* called once, when done */
};

/* A fire mission, whose rounds are due in simulated time. */
struct fire_mission {
    uint32_t number; /* 1, 2, ...; 0: the place is free */
    struct command_series series;
};

struct command_queue {
    struct command_socket socket; /* of the client */
    struct command_client client;
    struct name_table names;
    int wake_fd;                     /* an eventfd that wakes the main thread */
    struct pending_command *pending; /* a list, the oldest first */
    uint32_t pending_count;
    struct fire_mission mission[COMMAND_QUEUE_MISSIONS];
    uint32_t missions; /* number of missions started so far */
};

/* Returns 0, or -1 with the error. */
int command_queue_open(struct command_queue *queue, const char *world, struct error_text *error);
/* Closes the queue. Pending commands are answered as if no reply had come. */
void command_queue_close(struct command_queue *queue);

/* Appends a command, which belongs to the queue until ready() is called. player NULL: the request
 * came without a player's key. Returns false, with the answer, if the command is refused or done at
 * once. */
bool command_queue_put(struct command_queue *queue, struct pending_command *pending,
                       struct player *player, uint64_t now_ns, struct http_answer *answer);

/* Sends the commands that are due and answers those whose reply has come. */
void command_queue_turn(struct command_queue *queue, struct players *players,
                        const struct world_reader *reader, uint64_t now_ns);

/* Called when the world was replaced or removed: takes all vehicles from their players and reads
 * the names of the new world's vehicles. */
void command_queue_world_changed(struct command_queue *queue, struct players *players,
                                 const struct world_reader *reader);

/* Blocks until a command is appended, a reply comes, or until_ns (CLOCK_MONOTONIC). */
void command_queue_wait(struct command_queue *queue, uint64_t until_ns);

#endif
