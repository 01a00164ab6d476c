/* Accepts clients, reads commands and sends replies. */
#include "reporter/intake/client_sockets.h"

#include "ipc/process/clock.h"
#include "ipc/segment/local_socket.h"
#include "ipc/process/log.h"
#include "ipc/topics/command_packet.h"

#include <errno.h>
#include <stddef.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define ACCEPT_AT_ONCE 8
#define BACKLOG        64

int client_sockets_open(struct client_sockets *sockets, const char *world, struct error_text *error)
{
    *sockets = (struct client_sockets){.listener = -1, .user = geteuid()};
    for (uint32_t i = 0; i < ADMISSION_SOURCES; i++)
        sockets->client[i].fd = -1;
    sockets->listener = local_socket_listen(world, COMMAND_SOCKET_SUFFIX,
                                            SOCK_SEQPACKET | SOCK_NONBLOCK, BACKLOG, error);
    return sockets->listener < 0 ? -1 : 0;
}

void client_sockets_close(struct client_sockets *sockets)
{
    for (uint32_t i = 0; i < ADMISSION_SOURCES; i++) {
        if (sockets->client[i].fd >= 0)
            close(sockets->client[i].fd);
    }
    close(sockets->listener);
}

static void close_client(struct client_sockets *sockets, struct admission *admission, uint32_t i)
{
    close(sockets->client[i].fd);
    sockets->client[i].fd = -1;
    sockets->client[i].key = 0;
    admission_leave(admission, i);
}

/* --- accepting ---------------------------------------------------------------------------------*/

static uint32_t connections_of(const struct client_sockets *sockets, pid_t pid)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < ADMISSION_SOURCES; i++)
        count += sockets->client[i].key && sockets->client[i].pid == pid;
    return count;
}

/* Returns the client that a new client evicts: of the process with the most connections, the one
 * that has been silent for longest. Returns ADMISSION_SOURCES if the new client's process has as
 * many. */
static uint32_t find_evicted(const struct client_sockets *sockets, uint32_t newcomers)
{
    uint32_t evicted = ADMISSION_SOURCES, most = newcomers;
    for (uint32_t i = 0; i < ADMISSION_SOURCES; i++) {
        const struct client *client = &sockets->client[i];
        uint32_t count = connections_of(sockets, client->pid);
        if (count > most || (evicted < ADMISSION_SOURCES && count == most &&
                             client->heard_ns < sockets->client[evicted].heard_ns)) {
            evicted = i;
            most = count;
        }
    }
    return evicted;
}

/* Returns the entry for a new client of a process with so many connections, ADMISSION_SOURCES if
 * there is none. */
static uint32_t find_entry(struct client_sockets *sockets, struct admission *admission,
                           uint32_t newcomers)
{
    for (uint32_t i = 0; i < ADMISSION_SOURCES; i++) {
        if (!sockets->client[i].key)
            return i;
    }
    uint32_t evicted = find_evicted(sockets, newcomers);
    if (evicted < ADMISSION_SOURCES)
        close_client(sockets, admission, evicted);
    return evicted;
}

static void refuse(struct client_sockets *sockets, int fd, const char *detail, pid_t pid)
{
    if (log_due(&sockets->logged_ns, NS_PER_S))
        log_warn("process %d may not send commands: %s", (int)pid, detail);
    close(fd);
}

static void admit(struct client_sockets *sockets, struct admission *admission, int fd,
                  uint64_t now_ns)
{
    struct ucred peer;
    if (!local_socket_peer(fd, &peer)) {
        close(fd);
        return;
    }
    if (peer.uid != sockets->user && peer.uid != 0) {
        refuse(sockets, fd, "it belongs to another user", peer.pid);
        return;
    }
    uint32_t others = connections_of(sockets, peer.pid);
    if (others >= CLIENTS_PER_PROCESS) {
        refuse(sockets, fd, "it has too many connections already", peer.pid);
        return;
    }
    uint32_t i = find_entry(sockets, admission, others);
    if (i == ADMISSION_SOURCES) {
        refuse(sockets, fd, "all places are taken", peer.pid);
        return;
    }
    sockets->client[i] =
        (struct client){.fd = fd, .key = ++sockets->last_key, .pid = peer.pid, .heard_ns = now_ns};
    admission_enter(admission, i, sockets->client[i].key);
}

static void accept_new(struct client_sockets *sockets, struct admission *admission, uint64_t now_ns)
{
    for (int i = 0; i < ACCEPT_AT_ONCE; i++) {
        int fd = accept4(sockets->listener, NULL, NULL, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (fd < 0)
            return;
        admit(sockets, admission, fd, now_ns);
    }
}

/* --- reading -----------------------------------------------------------------------------------*/

/* Makes any bytes a valid object: the text gets an end, and the truth value becomes 0 or 1. */
static void make_valid(struct command_packet *packet)
{
    unsigned char anyway;
    unsigned char *bytes = (unsigned char *)packet;
    const size_t at = offsetof(struct command_packet, command) + offsetof(jolon_Command, anyway);
    memcpy(&anyway, bytes + at, 1);
    anyway = anyway != 0;
    memcpy(bytes + at, &anyway, 1);
    packet->command.kind[sizeof packet->command.kind - 1] = '\0';
}

/* Returns false when the client must be closed. */
static bool read_one(struct client_sockets *sockets, struct admission *admission, uint32_t i,
                     uint64_t now_ns, bool *more)
{
    struct command_packet packet;
    struct client *client = &sockets->client[i];
    ssize_t bytes = recv(client->fd, &packet, sizeof packet, MSG_DONTWAIT | MSG_TRUNC);
    *more = false;
    if (bytes < 0)
        return errno == EAGAIN || errno == EINTR;
    if (bytes == 0)
        return false;
    if (bytes != (ssize_t)sizeof packet || packet.magic != COMMAND_PACKET_MAGIC ||
        packet.version != COMMAND_PACKET_VERSION) {
        if (log_due(&sockets->logged_ns, NS_PER_S))
            log_warn("process %d sent %zd bytes that are no command of this build: hung up",
                     (int)client->pid, bytes);
        return false;
    }
    make_valid(&packet);
    client->heard_ns = now_ns;
    admission_put(admission, i, &packet.command);
    *more = true;
    return true;
}

/* Closes clients that hung up, also those whose commands are not being read. */
static void close_hung_up(struct client_sockets *sockets, struct admission *admission)
{
    struct pollfd polled[ADMISSION_SOURCES];
    for (uint32_t i = 0; i < ADMISSION_SOURCES; i++)
        polled[i] = (struct pollfd){.fd = sockets->client[i].fd};
    if (poll(polled, ADMISSION_SOURCES, 0) <= 0)
        return;
    for (uint32_t i = 0; i < ADMISSION_SOURCES; i++) {
        if (polled[i].fd >= 0 && polled[i].revents & (POLLHUP | POLLERR))
            close_client(sockets, admission, i);
    }
}

void client_sockets_receive(struct client_sockets *sockets, struct admission *admission,
                            uint64_t now_ns)
{
    close_hung_up(sockets, admission);
    accept_new(sockets, admission, now_ns);
    for (uint32_t i = 0; i < ADMISSION_SOURCES; i++) {
        bool more = sockets->client[i].fd >= 0;
        while (more && admission_room(admission, i)) {
            if (!read_one(sockets, admission, i, now_ns, &more))
                close_client(sockets, admission, i);
        }
    }
}

/* --- replies -----------------------------------------------------------------------------------*/

void client_sockets_reply(struct client_sockets *sockets, uint64_t client,
                          const jolon_CommandReply *reply)
{
    struct reply_packet packet;
    memset(&packet, 0, sizeof packet); /* the padding goes out too */
    packet.magic = COMMAND_PACKET_MAGIC;
    packet.version = COMMAND_PACKET_VERSION;
    packet.reply = *reply;
    for (uint32_t i = 0; i < ADMISSION_SOURCES && client; i++) {
        if (sockets->client[i].key == client)
            (void)send(sockets->client[i].fd, &packet, sizeof packet, MSG_DONTWAIT | MSG_NOSIGNAL);
    }
}

void client_sockets_wait(const struct client_sockets *sockets, const struct admission *admission,
                         uint64_t until_ns)
{
    struct pollfd polled[1 + ADMISSION_SOURCES] = {{.fd = sockets->listener, .events = POLLIN}};
    nfds_t count = 1;
    for (uint32_t i = 0; i < ADMISSION_SOURCES; i++) {
        if (sockets->client[i].fd >= 0 && admission_room(admission, i))
            polled[count++] = (struct pollfd){.fd = sockets->client[i].fd, .events = POLLIN};
    }
    uint64_t now_ns = clock_now_ns();
    uint64_t left_ns = until_ns > now_ns ? until_ns - now_ns : 0;
    struct timespec left = {.tv_sec = (time_t)(left_ns / NS_PER_S),
                            .tv_nsec = (long)(left_ns % NS_PER_S)};
    (void)ppoll(polled, count, &left, NULL);
}
