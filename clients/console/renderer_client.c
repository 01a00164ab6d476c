/* HTTP client of the renderer. */
#include "clients/console/renderer_client.h"

#include "ipc/process/clock.h"
#include "ipc/segment/picture_socket.h"
#include "ipc/segment/segment.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#define ROOM_FIRST 65536u

/* --- reading an answer -------------------------------------------------------------------------*/

/* Returns the value of a header in a head of NUL-terminated lines, or "". */
static const char *head_value(const char *head, const char *end, const char *name)
{
    size_t length = strlen(name);
    for (const char *line = head; line < end; line += strlen(line) + 1) {
        if (strncasecmp(line, name, length) == 0 && line[length] == ':')
            return line + length + 1 + strspn(line + length + 1, " \t");
    }
    return "";
}

static void copy_value(char *to, size_t room, const char *value)
{
    size_t length = strspn(value, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                  "/.;=-+ ");
    length = length < room ? length : room - 1;
    memcpy(to, value, length);
    to[length] = '\0';
}

bool renderer_client_read(struct picture_copy *copy)
{
    char *end = copy->count ? memmem(copy->bytes, copy->count, "\r\n\r\n", 4) : NULL;
    unsigned status;
    if (!end || memchr(copy->bytes, '\0', (size_t)(end - copy->bytes)))
        return false;
    copy->body = end + 4;
    copy->body_bytes = copy->count - (size_t)(copy->body - copy->bytes);
    end[0] = '\0';
    for (char *c = copy->bytes; c < end; c++) {
        if (*c == '\r' || *c == '\n')
            *c = '\0';
    }
    if (sscanf(copy->bytes, "HTTP/1.%*1u %3u", &status) != 1 || status < 200 || status > 599)
        return false;
    const char *length = head_value(copy->bytes, end, "Content-Length");
    if (!*length || strtoull(length, NULL, 10) != copy->body_bytes)
        return false;
    copy->number = strtoull(head_value(copy->bytes, end, "X-Picture"), NULL, 10);
    copy_value(copy->type, sizeof copy->type, head_value(copy->bytes, end, "Content-Type"));
    copy_value(copy->frame, sizeof copy->frame, head_value(copy->bytes, end, "X-Frame"));
    copy_value(copy->time, sizeof copy->time, head_value(copy->bytes, end, "X-Time"));
    copy->status = status;
    return true;
}

/* --- the socket --------------------------------------------------------------------------------*/

static int connect_renderer(const char *world)
{
    char suffix[LOCAL_SOCKET_SUFFIX_MAX];
    struct error_text error;
    picture_socket_suffix(suffix, ROLE_RENDERER);
    return local_socket_connect(world, suffix, SOCK_STREAM | SOCK_NONBLOCK, &error);
}

static bool wait_for(int fd, short what, uint64_t until_ns)
{
    uint64_t now_ns = clock_now_ns();
    struct pollfd poller = {.fd = fd, .events = what};
    if (now_ns >= until_ns)
        return false;
    return poll(&poller, 1, (int)((until_ns - now_ns) / NS_PER_MS) + 1) == 1;
}

/* The request fits into any socket's buffer. */
static bool send_request(int fd, const char *target, uint64_t after)
{
    char text[PICTURE_PROXY_TARGET + 128], number[48] = "";
    if (after)
        (void)snprintf(number, sizeof number, "%cafter=%llu", strchr(target, '?') ? '&' : '?',
                       (unsigned long long)after);
    int length = snprintf(text, sizeof text,
                          "GET %s%s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
                          target, number);
    return length > 0 && (size_t)length < sizeof text &&
           send(fd, text, (size_t)length, MSG_NOSIGNAL) == length;
}

static bool make_room(struct picture_copy *copy)
{
    if (copy->count < copy->room)
        return true;
    size_t room = copy->room ? 2 * copy->room : ROOM_FIRST;
    char *bytes = room <= PICTURE_PROXY_MAX ? realloc(copy->bytes, room) : NULL;
    if (!bytes)
        return false;
    copy->bytes = bytes;
    copy->room = room;
    return true;
}

/* Receives until the renderer closes the connection. */
static bool receive(int fd, struct picture_copy *copy, uint64_t until_ns)
{
    while (make_room(copy)) {
        ssize_t count = recv(fd, copy->bytes + copy->count, copy->room - copy->count, 0);
        if (count == 0)
            return true;
        if (count > 0)
            copy->count += (size_t)count;
        else if ((errno != EAGAIN && errno != EINTR) || !wait_for(fd, POLLIN, until_ns))
            return false;
    }
    return false;
}

struct picture_copy *renderer_client(const char *world, const char *target, uint64_t after,
                                     uint64_t until_ns)
{
    struct picture_copy *copy = calloc(1, sizeof *copy);
    if (!copy)
        return NULL;
    atomic_store(&copy->holders, 1);
    int fd = connect_renderer(world);
    if (fd < 0)
        return copy;
    if (!send_request(fd, target, after) || !receive(fd, copy, until_ns) ||
        !renderer_client_read(copy))
        copy->status = 0;
    close(fd);
    return copy;
}
