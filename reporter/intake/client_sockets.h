/* The local clients of the intake: processes of the same user that send commands over a socket in
 * the world's runtime folder. The kernel names each client's user and process (SO_PEERCRED).
 *
 * Clients of another user than the world's are refused, but for root. One process has at most
 * CLIENTS_PER_PROCESS connections. When all places are taken, a new client gets the place of the
 * process that has the most, of its connections the one that has been silent longest. An evicted
 * client connects again with its next command. A client that hangs up gives up what was not yet
 * taken, as nobody would hear the answer. So processes with many connections keep out
 * themselves, and nobody else. Nothing here blocks. One thread. */
#ifndef JOLON_REPORTER_INTAKE_CLIENT_SOCKETS_H
#define JOLON_REPORTER_INTAKE_CLIENT_SOCKETS_H

#include "reporter/intake/admission.h"
#include "ipc/segment/segment.h"

#include <poll.h>
#include <sys/types.h>

#define CLIENTS_PER_PROCESS 16u

struct client {
    int fd;
    uint64_t key; /* counted from 1, never used again; 0: the place is free */
    pid_t pid;
    uint64_t heard_ns;
};

struct client_sockets {
    int listener;
    uid_t user; /* of this process, and so of the world */
    uint64_t last_key;
    struct client client[ADMISSION_SOURCES]; /* in the places of struct admission */
    uint64_t logged_ns;
};

/* Listens on the world's command socket. The caller holds ROLE_INTAKE, so that a socket file which
 * is already there belongs to nobody. 0, or -1 with the reason. */
int client_sockets_open(struct client_sockets *sockets, const char *world,
                        struct error_text *error);
void client_sockets_close(struct client_sockets *sockets);

/* Accepts new clients and reads the commands for which the clients' queues have room. Lets go of
 * clients that hung up or that sent anything but command packets. */
void client_sockets_receive(struct client_sockets *sockets, struct admission *admission,
                            uint64_t now_ns);

/* Sends a reply. A client that has gone, or that does not read, misses it and repeats its command.
 */
void client_sockets_reply(struct client_sockets *sockets, uint64_t client,
                          const jolon_CommandReply *reply);

/* Waits until there is something to receive, at most until until_ns (CLOCK_MONOTONIC). */
void client_sockets_wait(const struct client_sockets *sockets, const struct admission *admission,
                         uint64_t until_ns);

#endif
