/* The stream's views and the thread that encodes them. */
#include "renderer/output/stream.h"

#include "ipc/clock.h"
#include "ipc/log.h"
#include "renderer/image/jpeg.h"
#include "renderer/output/outlet.h"
#include "renderer/output/stream_inside.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define QUALITY 80
#define BACKLOG 16
#define SEND_BYTES                                                                                 \
    (256 * 1024) /* of a client's socket: more would only make what it sees older                  \
                  */
/* A picture that stands is sent again: so a browser does not give up, and who is gone is noticed.
 */
#define REPEAT_NS (2ull * NS_PER_S)

/* --- listening ---------------------------------------------------------------------------------*/

static int bind_to(int family, const struct sockaddr *address, socklen_t length)
{
    const int one = 1, bytes = SEND_BYTES;
    int fd = socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd < 0)
        return -1;
    /* The port of a renderer that has just died is ours again. */
    if (setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one) == 0 &&
        setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes) == 0 &&
        bind(fd, address, length) == 0 && listen(fd, BACKLOG) == 0)
        return fd;
    int cause = errno;
    close(fd);
    errno = cause;
    return -1;
}

static int listen_four(struct stream *stream, const struct in_addr *address, uint16_t port)
{
    struct sockaddr_in socket_address = {
        .sin_family = AF_INET, .sin_addr = *address, .sin_port = htons(port)};
    socklen_t length = sizeof socket_address;
    char text[INET_ADDRSTRLEN];
    stream->listener = bind_to(AF_INET, (struct sockaddr *)&socket_address, length);
    if (stream->listener < 0 ||
        getsockname(stream->listener, (struct sockaddr *)&socket_address, &length) != 0)
        return -1;
    stream->local = ntohl(address->s_addr) >> 24 == IN_LOOPBACKNET;
    snprintf(stream->url, sizeof stream->url, "http://%s:%u/",
             inet_ntop(AF_INET, address, text, sizeof text), ntohs(socket_address.sin_port));
    return 0;
}

static int listen_six(struct stream *stream, const struct in6_addr *address, uint16_t port)
{
    struct sockaddr_in6 socket_address = {
        .sin6_family = AF_INET6, .sin6_addr = *address, .sin6_port = htons(port)};
    socklen_t length = sizeof socket_address;
    char text[INET6_ADDRSTRLEN];
    stream->listener = bind_to(AF_INET6, (struct sockaddr *)&socket_address, length);
    if (stream->listener < 0 ||
        getsockname(stream->listener, (struct sockaddr *)&socket_address, &length) != 0)
        return -1;
    stream->local = IN6_IS_ADDR_LOOPBACK(address);
    snprintf(stream->url, sizeof stream->url, "http://[%s]:%u/",
             inet_ntop(AF_INET6, address, text, sizeof text), ntohs(socket_address.sin6_port));
    return 0;
}

struct stream *stream_open(const char *address, uint16_t port, const char *world,
                           struct reason *reason)
{
    struct in_addr four;
    struct in6_addr six;
    int result;
    struct stream *stream = calloc(1, sizeof *stream);
    if (stream == NULL) {
        reason_set(reason, "no memory for a stream");
        return NULL;
    }
    stream->listener = -1;
    if (inet_pton(AF_INET, address, &four) == 1) {
        result = listen_four(stream, &four, port);
    } else if (inet_pton(AF_INET6, address, &six) == 1) {
        result = listen_six(stream, &six, port);
    } else {
        reason_set(reason, "--stream-address %s: must be an address, as 127.0.0.1 or ::1", address);
        free(stream);
        return NULL;
    }
    if (result != 0) {
        reason_set(reason, "--stream %u: cannot listen on %s port %u: %s", port, address, port,
                   errno == EADDRINUSE ? "it is in use; name another" : strerror(errno));
        free(stream);
        return NULL;
    }
    if (!stream->local)
        log_warn("the stream is open to whoever reaches %s: it has no password", address);
    snprintf(stream->world, sizeof stream->world, "%s", world);
    return stream;
}

const char *stream_url(const struct stream *stream)
{
    return stream->url;
}

/* --- views -------------------------------------------------------------------------------------*/

struct stream_view *stream_find(struct stream *stream, const char *name, size_t length)
{
    for (uint32_t i = 0; i < stream->views; i++) {
        if (strlen(stream->view[i].name) == length &&
            memcmp(stream->view[i].name, name, length) == 0)
            return &stream->view[i];
    }
    return NULL;
}

/* Names stand in addresses and pages as they are. */
static bool is_plain(const char *name)
{
    static const char letters[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
    return name[0] != '\0' && name[strspn(name, letters)] == '\0';
}

void stream_put(struct stream *stream, struct picture *picture)
{
    pthread_mutex_lock(&stream->lock);
    struct stream_view *view = stream_find(stream, picture->view, strlen(picture->view));
    if (view == NULL && stream->views < STREAM_VIEWS_MAX && is_plain(picture->view)) {
        view = &stream->view[stream->views++];
        snprintf(view->name, sizeof view->name, "%s", picture->view);
    }
    if (view != NULL) {
        picture_release(view->fresh);
        view->fresh = picture_hold(picture);
        view->drawn++;
        if (view->watchers + view->askers > 0)
            pthread_cond_signal(&stream->come);
    }
    pthread_mutex_unlock(&stream->lock);
}

struct stream_jpeg *stream_hold(struct stream_jpeg *jpeg)
{
    jpeg->holders++;
    return jpeg;
}

void stream_release(struct stream_jpeg *jpeg)
{
    if (jpeg == NULL || --jpeg->holders > 0)
        return;
    free(jpeg->bytes);
    free(jpeg);
}

/* --- encoding ----------------------------------------------------------------------------------*/

static struct stream_jpeg *encode(const struct picture *picture)
{
    struct stream_jpeg *jpeg = malloc(sizeof *jpeg);
    if (jpeg == NULL)
        return NULL;
    *jpeg = (struct stream_jpeg){.holders = 1,
                                 .width = picture->image.width,
                                 .height = picture->image.height,
                                 .frame = picture->frame,
                                 .time_s = picture->time_s};
    if (jpeg_encode(&picture->image, QUALITY, &jpeg->bytes, &jpeg->count) == 0)
        return jpeg;
    free(jpeg);
    return NULL;
}

/* Under the lock, which it leaves meanwhile. Out of memory the picture is left out. */
static void renew(struct stream *stream, struct stream_view *view)
{
    struct picture *picture = view->fresh;
    view->fresh = NULL;
    pthread_mutex_unlock(&stream->lock);
    struct stream_jpeg *jpeg = encode(picture);
    picture_release(picture);
    pthread_mutex_lock(&stream->lock);
    if (jpeg == NULL)
        return;
    stream_release(view->jpeg);
    view->jpeg = jpeg;
    view->encoded++;
}

/* One look at every view, under the lock; true when something was done. */
static bool serve_views(struct stream *stream)
{
    bool done = false;
    for (uint32_t i = 0; i < stream->views && !stream->ending; i++) {
        struct stream_view *view = &stream->view[i];
        uint64_t now = clock_now_ns();
        if (view->watchers + view->askers == 0)
            continue;
        if (view->fresh != NULL)
            renew(stream, view);
        else if (view->jpeg == NULL || (view->askers == 0 && now < view->shown_ns + REPEAT_NS))
            continue;
        view->number++;
        view->shown_ns = now;
        stream_http_wake(stream, view);
        done = true;
    }
    return done;
}

static void wait_shortly(struct stream *stream)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_sec++;
    pthread_cond_timedwait(&stream->come, &stream->lock, &until);
}

static void *serve(void *argument)
{
    struct stream *stream = argument;
    setpriority(PRIO_PROCESS, 0, OUTLET_NICENESS); /* this thread's alone */
    pthread_mutex_lock(&stream->lock);
    while (!stream->ending) {
        if (!serve_views(stream))
            wait_shortly(stream);
    }
    pthread_mutex_unlock(&stream->lock);
    return NULL;
}

int stream_start(struct stream *stream, struct reason *reason)
{
    sigset_t all, before;
    pthread_condattr_t monotonic;
    pthread_mutex_init(&stream->lock, NULL);
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&stream->come, &monotonic);
    pthread_condattr_destroy(&monotonic);
    /* Signals are the drawing thread's. */
    sigfillset(&all);
    sigdelset(&all, SIGSYS); /* what the sandbox forbids is to be told */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int result = stream_http_start(stream);
    if (result == 0 && (errno = pthread_create(&stream->thread, NULL, serve, stream)) != 0) {
        stream_http_end(stream);
        result = -1;
    }
    int cause = errno;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return result == 0 ? 0 : reason_set(reason, "cannot start the stream: %s", strerror(cause));
}

void stream_close(struct stream *stream)
{
    if (stream == NULL)
        return;
    if (stream->daemon != NULL) {
        pthread_mutex_lock(&stream->lock);
        stream->ending = true;
        pthread_cond_signal(&stream->come);
        pthread_mutex_unlock(&stream->lock);
        pthread_join(stream->thread, NULL);
        stream_http_end(stream);
        pthread_cond_destroy(&stream->come);
        pthread_mutex_destroy(&stream->lock);
    }
    for (uint32_t i = 0; i < stream->views; i++) {
        picture_release(stream->view[i].fresh);
        stream_release(stream->view[i].jpeg);
    }
    if (stream->listener >= 0)
        close(stream->listener);
    free(stream);
}
