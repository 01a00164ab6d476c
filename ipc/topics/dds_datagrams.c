/* sendmsg() and recvmsg(), and the list of participants. */
#include "ipc/topics/dds_datagrams.h"

#include "ipc/process/clock.h"
#include "ipc/topics/rtps_filter.h"

#include <netinet/in.h>
#include <pthread.h>
#include <stdint.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

/* Participants in the list. Of more, those heard of last stay. */
#define PARTICIPANTS_MAX 1024u

/* A participant that is silent, as it was killed, stays in the list for so long. Announcements come
 * at least every 30 s (Cyclone DDS's own interval). */
#define SILENCE_NS ((uint64_t)60 * NS_PER_S)

#define ANNOUNCEMENT_BYTES 512u /* an announcement is within so many bytes of a datagram */

struct participant {
    struct rtps_locator at; /* port 0: the entry is free */
    uint8_t prefix[RTPS_PREFIX_BYTES];
    uint64_t heard_ns;
};

static struct {
    pthread_mutex_t lock;
    bool forget;
    struct participant participant[PARTICIPANTS_MAX];
} datagrams = {.lock = PTHREAD_MUTEX_INITIALIZER};

void dds_datagrams_begin(bool forget)
{
    (void)pthread_mutex_lock(&datagrams.lock);
    datagrams.forget = forget;
    memset(datagrams.participant, 0, sizeof datagrams.participant);
    (void)pthread_mutex_unlock(&datagrams.lock);
}

static bool same_address(const struct rtps_locator *a, const struct rtps_locator *b)
{
    return a->address == b->address && a->port == b->port;
}

/* Updates the participant's entry, or replaces the one that has been silent for longest. */
static void note(const struct rtps_locator *at, const uint8_t *prefix, uint64_t now_ns)
{
    struct participant *entry = &datagrams.participant[0];
    for (uint32_t i = 0; i < PARTICIPANTS_MAX && !same_address(&entry->at, at); i++) {
        if (same_address(&datagrams.participant[i].at, at) ||
            datagrams.participant[i].heard_ns < entry->heard_ns)
            entry = &datagrams.participant[i];
    }
    *entry = (struct participant){.at = *at, .heard_ns = now_ns};
    memcpy(entry->prefix, prefix, RTPS_PREFIX_BYTES);
}

static void forget(const uint8_t *prefix)
{
    for (uint32_t i = 0; i < PARTICIPANTS_MAX; i++) {
        if (memcmp(datagrams.participant[i].prefix, prefix, RTPS_PREFIX_BYTES) == 0)
            datagrams.participant[i] = (struct participant){0};
    }
}

static void take_announcement(const struct rtps_announcement *announcement,
                              const struct sockaddr_in *from)
{
    const struct rtps_locator source = {from->sin_addr.s_addr, ntohs(from->sin_port)};
    uint64_t now_ns = clock_now_ns();
    (void)pthread_mutex_lock(&datagrams.lock);
    if (announcement->gone)
        forget(announcement->prefix);
    else if (announcement->locator_count == 0)
        note(&source, announcement->prefix, now_ns);
    for (uint32_t i = 0; announcement->here && i < announcement->locator_count; i++)
        note(&announcement->locator[i], announcement->prefix, now_ns);
    (void)pthread_mutex_unlock(&datagrams.lock);
}

static bool is_known(const struct sockaddr_in *to)
{
    const struct rtps_locator at = {to->sin_addr.s_addr, ntohs(to->sin_port)};
    uint64_t now_ns = clock_now_ns();
    bool found = false;
    (void)pthread_mutex_lock(&datagrams.lock);
    for (uint32_t i = 0; i < PARTICIPANTS_MAX && !found; i++) {
        found = same_address(&datagrams.participant[i].at, &at) &&
                now_ns - datagrams.participant[i].heard_ns < SILENCE_NS;
    }
    (void)pthread_mutex_unlock(&datagrams.lock);
    return found;
}

/* Copies the first bytes of a message. Returns their number and sets length to the whole length. */
static size_t beginning(const struct msghdr *message, uint8_t *bytes, size_t *length)
{
    size_t have = 0;
    *length = 0;
    for (size_t i = 0; i < message->msg_iovlen; i++) {
        const struct iovec *part = &message->msg_iov[i];
        size_t count =
            part->iov_len < ANNOUNCEMENT_BYTES - have ? part->iov_len : ANNOUNCEMENT_BYTES - have;
        if (count)
            memcpy(bytes + have, part->iov_base, count);
        have += count;
        *length += part->iov_len;
    }
    return have;
}

static bool is_unicast(const struct msghdr *message, struct sockaddr_in *to)
{
    if (!message->msg_name || message->msg_namelen < sizeof *to)
        return false;
    memcpy(to, message->msg_name, sizeof *to);
    return to->sin_family == AF_INET && !IN_MULTICAST(ntohl(to->sin_addr.s_addr));
}

ssize_t sendmsg(int fd, const struct msghdr *message, int flags)
{
    uint8_t bytes[ANNOUNCEMENT_BYTES];
    struct sockaddr_in to;
    size_t length;
    if (datagrams.forget && is_unicast(message, &to) &&
        rtps_announces(bytes, beginning(message, bytes, &length)) && !is_known(&to))
        return (ssize_t)length;
    return syscall(SYS_sendmsg, fd, message, flags);
}

ssize_t recvmsg(int fd, struct msghdr *message, int flags)
{
    struct rtps_announcement announcement;
    struct sockaddr_in from = {0};
    ssize_t length = syscall(SYS_recvmsg, fd, message, flags);
    if (length <= 0 || message->msg_iovlen != 1 || (size_t)length > message->msg_iov->iov_len)
        return length;
    uint8_t *datagram = message->msg_iov->iov_base;
    if (!rtps_filter(datagram, (size_t)length, &announcement))
        datagram[0] = 0; /* Cyclone DDS ignores a datagram without the mark "RTPS" */
    if (message->msg_name && message->msg_namelen >= sizeof from)
        memcpy(&from, message->msg_name, sizeof from);
    if (from.sin_family == AF_INET && (announcement.here || announcement.gone))
        take_announcement(&announcement, &from);
    return length;
}
