/* The stream's views and the thread that encodes them. */
#include "renderer/output/stream.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "renderer/image/jpeg.h"
#include "renderer/output/output_queue.h"
#include "renderer/output/stream_internal.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define QUALITY 80
/* An unchanged picture is sent again, so that browsers do not time out and lost clients are
 * noticed. */
#define REPEAT_NS (2ull * NS_PER_S)

/* --- opening -----------------------------------------------------------------------------------*/

struct stream *stream_open(const char *world, const struct stream_painter *painter,
                           struct error_text *error)
{
    struct stream *stream = calloc(1, sizeof *stream);
    if (stream == NULL) {
        error_text_set(error, "no memory for a stream");
        return NULL;
    }
    snprintf(stream->world, sizeof stream->world, "%s", world);
    if (painter != NULL)
        stream->painter = *painter;
    return stream;
}

const char *stream_url(const struct stream *stream)
{
    return stream->url;
}

/* --- views -------------------------------------------------------------------------------------*/

struct stream_view *stream_find_view(struct stream *stream, const char *name, size_t length)
{
    for (uint32_t i = 0; i < stream->views; i++) {
        if (strlen(stream->view[i].name) == length &&
            memcmp(stream->view[i].name, name, length) == 0)
            return &stream->view[i];
    }
    return NULL;
}

/* Returns true if a name needs no escaping in addresses and pages. */
static bool is_plain(const char *name)
{
    static const char letters[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
    return name[0] != '\0' && name[strspn(name, letters)] == '\0';
}

void stream_put(struct stream *stream, struct picture *picture)
{
    pthread_mutex_lock(&stream->lock);
    struct stream_view *view = stream_find_view(stream, picture->view, strlen(picture->view));
    if (view == NULL && stream->views < STREAM_VIEWS_MAX && is_plain(picture->view)) {
        view = &stream->view[stream->views++];
        snprintf(view->name, sizeof view->name, "%s", picture->view);
    }
    if (view != NULL) {
        picture_release(view->unencoded);
        view->unencoded = picture_hold(picture);
        view->drawn++;
        if (view->watchers + view->waiters > 0)
            pthread_cond_signal(&stream->encode_cond);
    }
    pthread_mutex_unlock(&stream->lock);
}

struct stream_jpeg *stream_hold(struct stream_jpeg *jpeg)
{
    atomic_fetch_add(&jpeg->references, 1);
    return jpeg;
}

void stream_release(void *jpeg)
{
    struct stream_jpeg *released = jpeg;
    if (released == NULL || atomic_fetch_sub(&released->references, 1) > 1)
        return;
    free(released->bytes);
    free(released);
}

/* --- encoding ----------------------------------------------------------------------------------*/

struct stream_jpeg *stream_encode(const struct image *image, uint64_t frame, double time_s)
{
    struct stream_jpeg *jpeg = malloc(sizeof *jpeg);
    if (jpeg == NULL)
        return NULL;
    *jpeg = (struct stream_jpeg){.references = 1,
                                 .width = image->width,
                                 .height = image->height,
                                 .frame = frame,
                                 .time_s = time_s};
    if (jpeg_encode(image, QUALITY, &jpeg->bytes, &jpeg->count) == 0)
        return jpeg;
    free(jpeg);
    return NULL;
}

/* Encodes the view's new picture. Called under the lock, which it leaves meanwhile. Without memory
 * the picture is dropped. */
static void renew(struct stream *stream, struct stream_view *view)
{
    struct picture *picture = view->unencoded;
    view->unencoded = NULL;
    pthread_mutex_unlock(&stream->lock);
    struct stream_jpeg *jpeg = stream_encode(&picture->image, picture->frame, picture->time_s);
    picture_release(picture);
    pthread_mutex_lock(&stream->lock);
    if (jpeg == NULL)
        return;
    stream_release(view->jpeg);
    view->jpeg = jpeg;
    view->encoded++;
}

/* Encodes the new pictures of watched views. Returns true if there were any. Under the lock. */
static bool serve_views(struct stream *stream)
{
    bool done = false;
    for (uint32_t i = 0; i < stream->views && !stream->ending; i++) {
        struct stream_view *view = &stream->view[i];
        uint64_t now = clock_now_ns();
        if (view->watchers + view->waiters == 0)
            continue;
        if (view->unencoded != NULL)
            renew(stream, view);
        else if (view->jpeg == NULL || (view->waiters == 0 && now < view->shown_ns + REPEAT_NS))
            continue;
        view->number++;
        view->shown_ns = now;
        stream_http_wake(stream, view);
        done = true;
    }
    return done;
}

/* The same for requested pictures. A JPEG is dropped if its row was reused while it was encoded. */
static bool serve_requests(struct stream *stream)
{
    bool done = false;
    for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX && !stream->ending; i++) {
        struct stream_view *view = &stream->request_view[i];
        if (view->waiters == 0 || view->unencoded == NULL)
            continue;
        uint64_t generation = stream->requests.row[i].generation;
        renew(stream, view);
        done = true;
        if (stream->requests.row[i].generation != generation) {
            stream_release(view->jpeg);
            view->jpeg = NULL;
            continue;
        }
        view->number = ++stream->numbers;
        view->shown_ns = clock_now_ns();
        stream_http_wake(stream, view);
    }
    return done;
}

/* Waits until there is something to encode or a client's wait ends, at most 1 s. Under the lock. */
static void wait_shortly(struct stream *stream)
{
    uint64_t now = clock_now_ns(), until = stream_http_expire(stream, now);
    until = until < now + NS_PER_S ? until : now + NS_PER_S;
    const struct timespec at = {.tv_sec = (time_t)(until / NS_PER_S),
                                .tv_nsec = (long)(until % NS_PER_S)};
    pthread_cond_timedwait(&stream->encode_cond, &stream->lock, &at);
}

static void *serve(void *argument)
{
    struct stream *stream = argument;
    process_lower_priority(OUTPUT_QUEUE_NICENESS); /* this thread's alone */
    pthread_mutex_lock(&stream->lock);
    while (!stream->ending) {
        bool done = serve_views(stream);
        stream_http_sweep(stream);
        if (!serve_requests(stream) && !done)
            wait_shortly(stream);
    }
    pthread_mutex_unlock(&stream->lock);
    return NULL;
}

/* --- starting and ending -----------------------------------------------------------------------*/

static void init_locks(struct stream *stream)
{
    pthread_condattr_t monotonic;
    pthread_mutex_init(&stream->lock, NULL);
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&stream->encode_cond, &monotonic);
    pthread_cond_init(&stream->draw_cond, &monotonic);
    pthread_cond_init(&stream->paint_cond, &monotonic);
    pthread_condattr_destroy(&monotonic);
}

static void end_threads(struct stream *stream, bool painting)
{
    pthread_mutex_lock(&stream->lock);
    stream->ending = true;
    pthread_cond_signal(&stream->encode_cond);
    pthread_cond_signal(&stream->paint_cond);
    pthread_mutex_unlock(&stream->lock);
    pthread_join(stream->encoding, NULL);
    if (painting)
        pthread_join(stream->painting, NULL);
}

/* Returns 0, or -1 with the reason and no thread. */
static int start_threads(struct stream *stream, struct error_text *error)
{
    int cause = pthread_create(&stream->encoding, NULL, serve, stream);
    if (cause != 0)
        return error_text_set(error, "cannot start the stream: %s", strerror(cause));
    cause = pthread_create(&stream->painting, NULL, stream_paint, stream);
    if (cause != 0) {
        end_threads(stream, false);
        return error_text_set(error, "cannot start the stream: %s", strerror(cause));
    }
    if (stream_http_start(stream, error) == 0)
        return 0;
    end_threads(stream, true);
    stream_http_end(stream);
    return -1;
}

int stream_start(struct stream *stream, struct error_text *error)
{
    sigset_t all, before;
    init_locks(stream);
    /* Signals must go to the drawing thread. */
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int result = start_threads(stream, error);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    stream->started = result == 0;
    return result;
}

static void release_view(struct stream_view *view)
{
    picture_release(view->unencoded);
    stream_release(view->jpeg);
}

void stream_close(struct stream *stream)
{
    if (stream == NULL)
        return;
    if (stream->started) {
        end_threads(stream, true);
        stream_http_end(stream);
        pthread_cond_destroy(&stream->paint_cond);
        pthread_cond_destroy(&stream->draw_cond);
        pthread_cond_destroy(&stream->encode_cond);
        pthread_mutex_destroy(&stream->lock);
    }
    for (uint32_t i = 0; i < stream->views; i++)
        release_view(&stream->view[i]);
    for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX; i++)
        release_view(&stream->request_view[i]);
    for (uint32_t i = 0; i < STREAM_MAPS; i++)
        release_view(&stream->map[i].view);
    for (uint32_t i = 0; i < stream->endpoints; i++)
        if (stream->endpoint[i].listener.fd >= 0)
            close(stream->endpoint[i].listener.fd);
    free(stream);
}
