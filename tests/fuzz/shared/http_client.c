/* One connection for each input. */
#include "tests/fuzz/shared/http_client.h"
#include "world/runtime/check.h"

#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#define ANSWER_BYTES 65536
/* Polls of a millisecond without a byte. */
#define LATE       4     /* tells the server that the input ends */
#define QUIET      40    /* the server may leave an input without an answer */
#define QUIET_GOOD 20000 /* a good request without an answer */

static socklen_t own_address(struct sockaddr_un *address)
{
    *address = (struct sockaddr_un){.sun_family = AF_UNIX};
    int used = snprintf(address->sun_path + 1, sizeof address->sun_path - 1, "jolon.fuzz.%d",
                        (int)getpid());
    return (socklen_t)(offsetof(struct sockaddr_un, sun_path) + 1 + (size_t)used);
}

struct http_listener http_client_listener(void)
{
    struct sockaddr_un address;
    socklen_t length = own_address(&address);
    int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    CHECK(fd >= 0 && bind(fd, (struct sockaddr *)&address, length) == 0 && listen(fd, 8) == 0);
    return (struct http_listener){.fd = fd, .local = true};
}

/* The server may have closed the connection and ignores the rest. */
static void send_all(int fd, const uint8_t *data, size_t size)
{
    while (size > 0) {
        ssize_t sent = send(fd, data, size, MSG_NOSIGNAL);
        if (sent <= 0)
            return;
        data += sent;
        size -= (size_t)sent;
    }
}

static size_t receive(int fd, char *answer, int most, void (*meanwhile)(void))
{
    struct pollfd poller = {.fd = fd, .events = POLLIN};
    size_t used = 0;
    for (int quiet = 0; quiet < most && used < ANSWER_BYTES;) {
        meanwhile();
        if (poll(&poller, 1, 1) != 1) {
            if (++quiet == LATE && most == QUIET)
                (void)shutdown(fd, SHUT_WR);
            continue;
        }
        ssize_t got = recv(fd, answer + used, ANSWER_BYTES - used, 0);
        if (got <= 0)
            break;
        used += (size_t)got;
        quiet = 0;
    }
    return used;
}

static size_t exchange(const uint8_t *data, size_t size, char *answer, int most,
                       void (*meanwhile)(void))
{
    struct sockaddr_un address;
    socklen_t length = own_address(&address);
    size_t first = size > 0 ? data[0] % size : 0;
    int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    CHECK(fd >= 0 && connect(fd, (struct sockaddr *)&address, length) == 0);
    send_all(fd, data, first);
    meanwhile();
    send_all(fd, data + first, size - first);
    size_t used = receive(fd, answer, most, meanwhile);
    close(fd);
    return used;
}

void http_client_send(const uint8_t *data, size_t size, void (*meanwhile)(void))
{
    char answer[ANSWER_BYTES];
    size_t used = exchange(data, size, answer, QUIET, meanwhile);
    CHECK(used < 12 || (memcmp(answer, "HTTP/1.", 7) == 0 && memcmp(answer + 9, "500", 3) != 0));
}

void http_client_get(const char *path, void (*meanwhile)(void))
{
    char request[128], answer[ANSWER_BYTES];
    int length = snprintf(request, sizeof request,
                          "GET %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", path);
    size_t used = exchange((const uint8_t *)request, (size_t)length, answer, QUIET_GOOD, meanwhile);
    CHECK(used > 12 && memcmp(answer, "HTTP/1.1 200", 12) == 0);
}
