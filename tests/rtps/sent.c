/* The sendmsg() of a peer replaces ipc/topics/dds_datagrams.c: a peer may send and receive
 * anything. */
#include "tests/rtps/sent.h"

#include "ipc/topics/dds_datagrams.h"

#include <pthread.h>
#include <stdint.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static FILE *kept;

void dds_datagrams_begin(bool forget)
{
    (void)forget;
}

void sent_keep(FILE *file)
{
    (void)pthread_mutex_lock(&lock);
    kept = file;
    (void)pthread_mutex_unlock(&lock);
}

static void keep(const struct msghdr *message)
{
    size_t length = 0;
    for (size_t i = 0; i < message->msg_iovlen; i++)
        length += message->msg_iov[i].iov_len;
    if (length > UINT16_MAX)
        return;
    const unsigned char head[2] = {(unsigned char)(length & 255), (unsigned char)(length >> 8)};
    (void)fwrite(head, 1, sizeof head, kept);
    for (size_t i = 0; i < message->msg_iovlen; i++)
        (void)fwrite(message->msg_iov[i].iov_base, 1, message->msg_iov[i].iov_len, kept);
}

ssize_t sendmsg(int fd, const struct msghdr *message, int flags)
{
    (void)pthread_mutex_lock(&lock);
    if (kept)
        keep(message);
    (void)pthread_mutex_unlock(&lock);
    return syscall(SYS_sendmsg, fd, message, flags);
}
