/* The local clients of the intake: processes of the same user that send commands over a socket in
 * the world's runtime folder. The kernel names each client's user and process (SO_PEERCRED).
 *
 * Clients of other users except root are refused. A process has at most CLIENTS_PER_PROCESS
 * connections. When all entries are taken, a new client evicts a connection of the process that has
 * the most, namely the one that has been silent for longest. So processes with many connections
 * evict only their own. An evicted client connects again with its next command. The waiting
 * commands of a client that disconnects are dropped, because their answers could not be delivered.
 * Nothing here blocks. One thread. */
#ifndef JOLON_REPORTER_INTAKE_CLIENT_SOCKETS_H
#define JOLON_REPORTER_INTAKE_CLIENT_SOCKETS_H

#include "reporter/intake/admission.h"
#include "ipc/segment/segment.h"

#include <poll.h>
#include <sys/types.h>

#define CLIENTS_PER_PROCESS 16u

struct client {
    int fd;
    uint64_t key; /* counted from 1 and never reused; 0: the entry is free */
    pid_t pid;
    uint64_t heard_ns;
};

struct client_sockets {
    int listener;
    uid_t user; /* of this process and of the world */
    uint64_t last_key;
    struct client client[ADMISSION_SOURCES]; /* at the indices of struct admission */
    uint64_t logged_ns;
};

/* Listens on the world's command socket. The caller holds ROLE_INTAKE, so no live process uses a
 * socket file that exists. Returns 0, or -1 with the reason. */
int client_sockets_open(struct client_sockets *sockets, const char *world,
                        struct error_text *error);
void client_sockets_close(struct client_sockets *sockets);

/* Accepts new clients and reads the commands for which their queues have room. Closes clients that
 * hung up or sent anything but command packets. */
void client_sockets_receive(struct client_sockets *sockets, struct admission *admission,
                            uint64_t now_ns);

/* Sends a reply. A client that has disconnected, or does not read, misses it and repeats its
 * command. */
void client_sockets_reply(struct client_sockets *sockets, uint64_t client,
                          const jolon_CommandReply *reply);

/* Waits until a client can be served, at most until until_ns (CLOCK_MONOTONIC). */
void client_sockets_wait(const struct client_sockets *sockets, const struct admission *admission,
                         uint64_t until_ns);

#endif
