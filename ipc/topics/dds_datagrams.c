/* The two calls, and who is there. */
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

/* Participants that are told of; of more, those that were heard of last. */
#define THERE_MAX 1024u

/* One that says nothing any more, as it was killed, is told for so long; announcements come every
 * 30 s at the least (Cyclone DDS's own interval). */
#define SILENCE_NS ((uint64_t)60 * NS_PER_S)

#define ANNOUNCEMENT_AT 512u /* within the first bytes of a datagram */

struct there {
    struct rtps_locator at; /* port 0: nobody */
    uint8_t prefix[RTPS_PREFIX_BYTES];
    uint64_t heard_ns;
};

static struct {
    pthread_mutex_t lock;
    bool forget;
    struct there there[THERE_MAX];
} datagrams = {.lock = PTHREAD_MUTEX_INITIALIZER};

void dds_datagrams_begin(bool forget)
{
    (void)pthread_mutex_lock(&datagrams.lock);
    datagrams.forget = forget;
    memset(datagrams.there, 0, sizeof datagrams.there);
    (void)pthread_mutex_unlock(&datagrams.lock);
}

static bool same_place(const struct rtps_locator *a, const struct rtps_locator *b)
{
    return a->address == b->address && a->port == b->port;
}

/* In the place that it has, or in the one that was silent for longest. */
static void note(const struct rtps_locator *at, const uint8_t *prefix, uint64_t now_ns)
{
    struct there *place = &datagrams.there[0];
    for (uint32_t i = 0; i < THERE_MAX && !same_place(&place->at, at); i++) {
        if (same_place(&datagrams.there[i].at, at) || datagrams.there[i].heard_ns < place->heard_ns)
            place = &datagrams.there[i];
    }
    *place = (struct there){.at = *at, .heard_ns = now_ns};
    memcpy(place->prefix, prefix, RTPS_PREFIX_BYTES);
}

static void forget(const uint8_t *prefix)
{
    for (uint32_t i = 0; i < THERE_MAX; i++) {
        if (memcmp(datagrams.there[i].prefix, prefix, RTPS_PREFIX_BYTES) == 0)
            datagrams.there[i] = (struct there){0};
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

static bool is_there(const struct sockaddr_in *to)
{
    const struct rtps_locator at = {to->sin_addr.s_addr, ntohs(to->sin_port)};
    uint64_t now_ns = clock_now_ns();
    bool found = false;
    (void)pthread_mutex_lock(&datagrams.lock);
    for (uint32_t i = 0; i < THERE_MAX && !found; i++) {
        found = same_place(&datagrams.there[i].at, &at) &&
                now_ns - datagrams.there[i].heard_ns < SILENCE_NS;
    }
    (void)pthread_mutex_unlock(&datagrams.lock);
    return found;
}

/* Its first bytes; their number, and its whole length. */
static size_t beginning(const struct msghdr *message, uint8_t *bytes, size_t *length)
{
    size_t have = 0;
    *length = 0;
    for (size_t i = 0; i < message->msg_iovlen; i++) {
        const struct iovec *part = &message->msg_iov[i];
        size_t count =
            part->iov_len < ANNOUNCEMENT_AT - have ? part->iov_len : ANNOUNCEMENT_AT - have;
        if (count)
            memcpy(bytes + have, part->iov_base, count);
        have += count;
        *length += part->iov_len;
    }
    return have;
}

static bool to_one(const struct msghdr *message, struct sockaddr_in *to)
{
    if (!message->msg_name || message->msg_namelen < sizeof *to)
        return false;
    memcpy(to, message->msg_name, sizeof *to);
    return to->sin_family == AF_INET && !IN_MULTICAST(ntohl(to->sin_addr.s_addr));
}

ssize_t sendmsg(int fd, const struct msghdr *message, int flags)
{
    uint8_t bytes[ANNOUNCEMENT_AT];
    struct sockaddr_in to;
    size_t length;
    if (datagrams.forget && to_one(message, &to) &&
        rtps_announces(bytes, beginning(message, bytes, &length)) && !is_there(&to))
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
        datagram[0] = 0; /* without its mark Cyclone DDS passes over it */
    if (message->msg_name && message->msg_namelen >= sizeof from)
        memcpy(&from, message->msg_name, sizeof from);
    if (from.sin_family == AF_INET && (announcement.here || announcement.gone))
        take_announcement(&announcement, &from);
    return length;
}
