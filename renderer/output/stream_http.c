/* The stream's clients. Functions run in an endpoint's server thread (ipc/http/server.h), except
 * those that start, end, sweep and wake. */
#include "renderer/output/stream_internal.h"

#include "ipc/process/clock.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PAGE_BYTES    8192
#define REQUEST_BYTES 64 /* a longer path names no picture */
#define BOUNDARY      "picture"
#define MULTIPART     "multipart/x-mixed-replace; boundary=" BOUNDARY

/* After each picture. Browsers show a picture when its boundary has arrived. */
static const char between[] = "\r\n--" BOUNDARY "\r\n";
#define BETWEEN_BYTES (sizeof between - 1)

static const struct http_header headers[] = {
    {"Content-Security-Policy", "default-src 'none'; img-src 'self'; style-src 'unsafe-inline'"},
    {NULL, NULL},
};

/* --- waiting -----------------------------------------------------------------------------------*/

/* Under the lock. */
static void wait_here(struct stream_client *client)
{
    struct stream *stream = client->stream;
    client->next = stream->waiting;
    stream->waiting = client;
    http_wait(client->request);
}

/* Removes a client from the waiting list and resumes its request. */
static void resume(struct stream_client **at)
{
    struct stream_client *client = *at;
    *at = client->next;
    client->view->waiters -= client->waits_once ? 1 : 0;
    http_wake(client->request);
}

void stream_http_wake(struct stream *stream, const struct stream_view *view)
{
    struct stream_client **at = &stream->waiting;
    while (*at != NULL) {
        if (view != NULL && (*at)->view != view)
            at = &(*at)->next;
        else
            resume(at);
    }
}

uint64_t stream_http_expire(struct stream *stream, uint64_t now_ns)
{
    struct stream_client **at = &stream->waiting;
    uint64_t next_ns = UINT64_MAX;
    while (*at != NULL) {
        uint64_t until_ns = (*at)->until_ns;
        if (until_ns != 0 && until_ns <= now_ns) {
            resume(at);
            continue;
        }
        if (until_ns != 0 && until_ns < next_ns)
            next_ns = until_ns;
        at = &(*at)->next;
    }
    return next_ns;
}

bool stream_wait_here(struct stream_client *client)
{
    client->waits_once = true;
    client->view->waiters++;
    pthread_cond_signal(&client->stream->encode_cond);
    wait_here(client);
    return false;
}

/* --- answers -----------------------------------------------------------------------------------*/

void stream_reply_jpeg(struct http_reply *reply, struct stream_jpeg *jpeg)
{
    *reply = (struct http_reply){.status = 200,
                                 .type = "image/jpeg",
                                 .bytes = jpeg->bytes,
                                 .count = jpeg->count,
                                 .release = stream_release,
                                 .owner = stream_hold(jpeg)};
}

void stream_refuse(struct http_reply *reply, unsigned status, const char *text)
{
    http_reply_text(reply, status, "text/plain; charset=utf-8", text);
}

static void refuse(struct http_reply *reply, unsigned status, const char *what, const char *next)
{
    char line[256];
    snprintf(line, sizeof line, "%s: %s\n", what, next);
    stream_refuse(reply, status, line);
}

static void reply_page(const struct stream *stream, struct http_reply *reply)
{
    char page[PAGE_BYTES];
    int used = snprintf(
        page, sizeof page,
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>Jolon: %s</title>"
        "<meta name=\"viewport\" "
        "content=\"width=device-width\">%s<style>body{margin:0;display:flex;"
        "flex-wrap:wrap;background:#16191c;color:#cdd3d8;font:14px "
        "sans-serif}figure{margin:8px;flex:"
        "1 1 480px}img{width:100%%;display:block}a{color:inherit}</style></head><body>",
        stream->world, stream->views == 0 ? "<meta http-equiv=\"refresh\" content=\"1\">" : "");
    for (uint32_t i = 0; i < stream->views; i++) {
        const char *name = stream->view[i].name;
        used += snprintf(page + used, sizeof page - (size_t)used,
                         "<figure><img src=\"/%s.mjpeg\" alt=\"%s\"><figcaption>%s <a href=\"/%s"
                         ".jpg\">picture</a></figcaption></figure>",
                         name, name, name, name);
    }
    snprintf(page + used, sizeof page - (size_t)used, "</body></html>\n");
    http_reply_text(reply, 200, "text/html; charset=utf-8", page);
}

static void reply_status(const struct stream *stream, struct http_reply *reply)
{
    char page[PAGE_BYTES];
    uint32_t watchers = 0;
    for (uint32_t i = 0; i < stream->views; i++)
        watchers += stream->view[i].watchers;
    int used = snprintf(page, sizeof page, "{\"world\":\"%s\",\"watchers\":%u,\"views\":[",
                        stream->world, watchers);
    for (uint32_t i = 0; i < stream->views; i++) {
        const struct stream_view *view = &stream->view[i];
        const struct stream_jpeg none = {0}, *jpeg = view->jpeg != NULL ? view->jpeg : &none;
        used += snprintf(page + used, sizeof page - (size_t)used,
                         "%s{\"view\":\"%s\",\"width\":%u,\"height\":%u,\"frame\":%llu,"
                         "\"time_s\":%.4f,\"bytes\":%zu,\"watchers\":%u,\"drawn\":%llu,"
                         "\"encoded\":%llu,\"skipped\":%llu}",
                         i > 0 ? "," : "", view->name, jpeg->width, jpeg->height,
                         (unsigned long long)jpeg->frame, jpeg->time_s, jpeg->count, view->watchers,
                         (unsigned long long)view->drawn, (unsigned long long)view->encoded,
                         (unsigned long long)view->skipped);
    }
    snprintf(page + used, sizeof page - (size_t)used, "]}\n");
    http_reply_text(reply, 200, "application/json", page);
}

/* --- one picture -------------------------------------------------------------------------------*/

/* Replies with the newest picture. The first call waits if it is not encoded yet. Under the lock.
 */
static bool reply_picture(struct stream_client *client, struct http_reply *reply)
{
    struct stream_view *view = client->view;
    struct stream *stream = client->stream;
    if (!client->waits_once && (view->unencoded != NULL || view->jpeg == NULL) && !stream->ending)
        return stream_wait_here(client);
    if (view->jpeg == NULL)
        stream_refuse(reply, 503, "no picture yet\n");
    else
        stream_reply_jpeg(reply, view->jpeg);
    return true;
}

/* --- all of them -------------------------------------------------------------------------------*/

/* Takes the view's picture if the client has not got it. Returns false if there is none. Under the
 * lock. */
static bool take_next(struct stream_client *client)
{
    const struct stream_view *view = client->view;
    if (view->jpeg == NULL || view->number == client->number)
        return false;
    bool first = client->number == 0;
    if (!first)
        client->view->skipped += view->number - client->number - 1;
    client->number = view->number;
    client->jpeg = stream_hold(view->jpeg);
    client->sent = 0;
    client->head_bytes =
        (size_t)snprintf(client->head, sizeof client->head,
                         "%sContent-Type: image/jpeg\r\nContent-Length: %zu\r\nX-Frame: "
                         "%llu\r\nX-Time: %.4f\r\n\r\n",
                         first ? "--" BOUNDARY "\r\n" : "", client->jpeg->count,
                         (unsigned long long)client->jpeg->frame, client->jpeg->time_s);
    return true;
}

/* Copies as much of the client's part, from `sent` on, as there is room for. Returns its bytes. */
static size_t copy_part(const struct stream_client *client, char *to, size_t room)
{
    const struct {
        const void *at;
        size_t bytes;
    } parts[] = {{client->head, client->head_bytes},
                 {client->jpeg->bytes, client->jpeg->count},
                 {between, BETWEEN_BYTES}};
    size_t from = client->sent, copied = 0;
    for (size_t i = 0; i < sizeof parts / sizeof parts[0] && copied < room; i++) {
        if (from >= parts[i].bytes) {
            from -= parts[i].bytes;
            continue;
        }
        size_t left = parts[i].bytes - from, fits = room - copied;
        size_t bytes = left < fits ? left : fits;
        memcpy(to + copied, (const char *)parts[i].at + from, bytes);
        copied += bytes;
        from = 0;
    }
    return copied;
}

static ssize_t give(struct http_request *request, char *to, size_t room)
{
    struct stream_client *client = request->own;
    struct stream *stream = client->stream;
    ssize_t given = 0;
    pthread_mutex_lock(&stream->lock);
    if (stream->ending) {
        given = -1;
    } else if (client->jpeg == NULL && !take_next(client)) {
        wait_here(client);
    } else {
        size_t bytes = copy_part(client, to, room);
        client->sent += bytes;
        if (client->sent == client->head_bytes + client->jpeg->count + BETWEEN_BYTES) {
            stream_release(client->jpeg);
            client->jpeg = NULL;
        }
        given = (ssize_t)bytes;
    }
    pthread_mutex_unlock(&stream->lock);
    return given;
}

/* Returns the place of a client, or a free one if client is NULL; NULL for none. Under the lock. */
static struct stream_client **find_place(struct stream *stream, const struct stream_client *client)
{
    for (uint32_t i = 0; i < STREAM_WATCHERS; i++)
        if (stream->watcher[i] == client)
            return &stream->watcher[i];
    return NULL;
}

/* Under the lock. */
static void stop_watching(struct stream_client **place)
{
    (*place)->view->watchers--;
    *place = NULL;
}

/* Returns a free place, or that of a client that does not read, whose connection is shut; NULL for
 * neither. Under the lock. */
static struct stream_client **make_place(struct stream *stream)
{
    struct stream_client **place = find_place(stream, NULL);
    uint64_t now_ns = clock_now_ns();
    for (uint32_t i = 0; i < STREAM_WATCHERS && place == NULL; i++) {
        if (!http_drop_stalled(stream->watcher[i]->request, now_ns))
            continue;
        place = &stream->watcher[i];
        stop_watching(place);
    }
    return place;
}

/* Under the lock. */
static void reply_stream(struct stream_client *client, struct http_reply *reply)
{
    struct stream_client **place = make_place(client->stream);
    if (place == NULL) {
        stream_refuse(reply, 503, "too many watch already\n");
        return;
    }
    *place = client;
    client->view->watchers++;
    pthread_cond_signal(&client->stream->encode_cond);
    *reply = (struct http_reply){.status = 200, .type = MULTIPART, .give = give};
}

/* --- requests ----------------------------------------------------------------------------------*/

static bool ends_with(const char *path, size_t length, const char *ending, size_t *stem)
{
    size_t bytes = strlen(ending);
    if (length <= bytes || strcmp(path + length - bytes, ending) != 0)
        return false;
    *stem = length - bytes;
    return true;
}

/* Returns false if the request waits. Under the lock. */
static bool reply_path(struct stream_client *client, const char *path, struct http_reply *reply)
{
    struct stream *stream = client->stream;
    size_t stem = 0, length = strnlen(path, REQUEST_BYTES);
    if (strcmp(path, "/picture.jpg") == 0)
        return stream_requests_picture(client, reply);
    if (strcmp(path, "/map.jpg") == 0 && stream->painter.paint != NULL &&
        (client->map != NULL || http_arguments(client->request, NULL, NULL) > 0))
        return stream_requests_map(client, reply);
    bool live = length < REQUEST_BYTES && ends_with(path, length, ".mjpeg", &stem);
    bool still = length < REQUEST_BYTES && ends_with(path, length, ".jpg", &stem);
    if (live || still)
        client->view = stream_find_view(stream, path + 1, stem - 1);
    if (client->view != NULL && still)
        return reply_picture(client, reply);
    if (client->view != NULL)
        reply_stream(client, reply);
    else if (strcmp(path, "/") == 0)
        reply_page(stream, reply);
    else if (strcmp(path, "/status.json") == 0)
        reply_status(stream, reply);
    else
        stream_refuse(reply, 404,
                      "there is /, /VIEW.mjpeg, /VIEW.jpg, /picture.jpg?view=&vehicle=&size=, "
                      "/map.jpg?x=&z=&metres=&size=, /status.json\n");
    return true;
}

static bool on_request(void *context, struct http_request *request, struct http_reply *reply)
{
    struct stream *stream = context;
    struct stream_client *client = request->own;
    client->stream = stream;
    client->request = request;
    if (strcmp(request->method, "GET") != 0 && strcmp(request->method, "HEAD") != 0) {
        stream_refuse(reply, 405, "pictures can only be looked at\n");
        http_reply_add(reply, "Allow", "GET, HEAD");
        return true;
    }
    if (!request->woken && !http_may_ask(request, false, clock_now_ns())) {
        stream_refuse(reply, 429, "too many requests: wait a second, then ask less often\n");
        return true;
    }
    pthread_mutex_lock(&stream->lock);
    bool replied = reply_path(client, request->path, reply);
    pthread_mutex_unlock(&stream->lock);
    return replied;
}

static void on_end(void *context, struct http_request *request)
{
    struct stream *stream = context;
    struct stream_client *client = request->own;
    pthread_mutex_lock(&stream->lock);
    struct stream_client **place = find_place(stream, client);
    stream_requests_end(client);
    if (place != NULL)
        stop_watching(place);
    pthread_mutex_unlock(&stream->lock);
    stream_release(client->jpeg);
}

/* --- starting and ending -----------------------------------------------------------------------*/

int stream_http_start(struct stream *stream, struct error_text *error)
{
    const struct http_handler handler = {.context = stream,
                                         .own_bytes = sizeof(struct stream_client),
                                         .headers = headers,
                                         .answer = on_request,
                                         .refuse = refuse,
                                         .end = on_end};
    for (uint32_t i = 0; i < stream->endpoints; i++) {
        struct http_server *server =
            http_server_start(&stream->endpoint[i].listener, &handler, error);
        if (server == NULL)
            return -1;
        pthread_mutex_lock(&stream->lock);
        stream->endpoint[i].server = server;
        pthread_mutex_unlock(&stream->lock);
    }
    return 0;
}

void stream_http_end(struct stream *stream)
{
    pthread_mutex_lock(&stream->lock);
    stream->ending = true;
    stream_http_wake(stream, NULL);
    pthread_mutex_unlock(&stream->lock);
    for (uint32_t i = 0; i < stream->endpoints; i++) {
        http_server_stop(stream->endpoint[i].server);
        stream->endpoint[i].server = NULL;
    }
}

void stream_http_sweep(struct stream *stream)
{
    for (uint32_t i = 0; i < stream->endpoints; i++)
        if (stream->endpoint[i].server != NULL)
            http_server_sweep(stream->endpoint[i].server, clock_now_ns());
}
