/* The stream's clients, by libmicrohttpd: one thread for all of a door, in which every function
 * here runs but those that start, end and wake it. */
#include "renderer/output/stream_inside.h"

#include "http/host.h"
#include "ipc/log.h"
#include "ipc/pictures.h"

#include <microhttpd.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

#define PATIENCE_S    10    /* with a client that neither reads nor asks */
#define MEMORY_BYTES  16384 /* of a connection: its request, and what is sent */
#define PART_BYTES    65536 /* of a picture at a time */
#define PAGE_BYTES    8192
#define REQUEST_BYTES 64 /* of a path that can name something here */
#define BOUNDARY      "picture"
#define MULTIPART     "multipart/x-mixed-replace; boundary=" BOUNDARY

/* Between the pictures. Browsers show one when its boundary has come, so that follows at once. */
static const char between[] = "\r\n--" BOUNDARY "\r\n";
#define BETWEEN_BYTES (sizeof between - 1)

/* --- waiting -----------------------------------------------------------------------------------*/

/* Under the lock, in one of the connection's own callbacks. */
static void wait_here(struct stream_client *client)
{
    struct stream *stream = client->stream;
    client->suspended = true;
    client->next = stream->waiting;
    stream->waiting = client;
    MHD_suspend_connection(client->connection);
}

/* Takes the client out of those that wait. */
static void go_on(struct stream_client **at)
{
    struct stream_client *client = *at;
    *at = client->next;
    client->suspended = false;
    client->view->askers -= client->asked ? 1 : 0;
    MHD_resume_connection(client->connection);
}

void stream_http_wake(struct stream *stream, const struct stream_view *view)
{
    struct stream_client **at = &stream->waiting;
    while (*at != NULL) {
        if (view != NULL && (*at)->view != view)
            at = &(*at)->next;
        else
            go_on(at);
    }
}

uint64_t stream_http_expire(struct stream *stream, uint64_t now_ns)
{
    struct stream_client **at = &stream->waiting;
    uint64_t next_ns = UINT64_MAX;
    while (*at != NULL) {
        uint64_t until_ns = (*at)->until_ns;
        if (until_ns != 0 && until_ns <= now_ns) {
            go_on(at);
            continue;
        }
        if (until_ns != 0 && until_ns < next_ns)
            next_ns = until_ns;
        at = &(*at)->next;
    }
    return next_ns;
}

struct stream_reply stream_wait_here(struct stream_client *client)
{
    client->asked = true;
    client->view->askers++;
    pthread_cond_signal(&client->stream->come);
    wait_here(client);
    return (struct stream_reply){.waits = true};
}

/* --- answers -----------------------------------------------------------------------------------*/

static enum MHD_Result send_reply(struct MHD_Connection *connection,
                                  const struct stream_reply *reply)
{
    struct MHD_Response *response = reply->response;
    if (response == NULL)
        return reply->waits ? MHD_YES : MHD_NO;
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, reply->type);
    MHD_add_response_header(response, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
    MHD_add_response_header(response, "X-Content-Type-Options", "nosniff");
    MHD_add_response_header(response, "Content-Security-Policy",
                            "default-src 'none'; img-src 'self'; style-src 'unsafe-inline'");
    if (reply->status == MHD_HTTP_METHOD_NOT_ALLOWED)
        MHD_add_response_header(response, MHD_HTTP_HEADER_ALLOW, "GET, HEAD");
    enum MHD_Result result = MHD_queue_response(connection, reply->status, response);
    MHD_destroy_response(response);
    return result;
}

struct stream_reply stream_reply_bytes(const void *bytes, size_t count, const char *type)
{
    union {
        const void *bytes;
        void *copied; /* it is not written to */
    } body = {bytes};
    return (struct stream_reply){
        .response = MHD_create_response_from_buffer(count, body.copied, MHD_RESPMEM_MUST_COPY),
        .status = MHD_HTTP_OK,
        .type = type};
}

struct stream_reply stream_refuse(unsigned status, const char *text)
{
    struct stream_reply reply = stream_reply_bytes(text, strlen(text), "text/plain; charset=utf-8");
    reply.status = status;
    return reply;
}

static struct stream_reply reply_page(const struct stream *stream)
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
    return stream_reply_bytes(page, strlen(page), "text/html; charset=utf-8");
}

static struct stream_reply reply_status(const struct stream *stream)
{
    char page[PAGE_BYTES];
    int used = snprintf(page, sizeof page, "{\"world\":\"%s\",\"watchers\":%u,\"views\":[",
                        stream->world, stream->watchers);
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
    return stream_reply_bytes(page, strlen(page), "application/json");
}

/* --- one picture -------------------------------------------------------------------------------*/

/* Under the lock. The newest one: when it is not encoded yet, the first call waits for that, and
 * libmicrohttpd calls again. */
static struct stream_reply reply_picture(struct stream_client *client)
{
    struct stream_view *view = client->view;
    struct stream *stream = client->stream;
    if (!client->asked && (view->fresh != NULL || view->jpeg == NULL) && !stream->ending)
        return stream_wait_here(client);
    if (view->jpeg == NULL)
        return stream_refuse(MHD_HTTP_SERVICE_UNAVAILABLE, "no picture yet\n");
    return stream_reply_bytes(view->jpeg->bytes, view->jpeg->count, "image/jpeg");
}

/* --- all of them -------------------------------------------------------------------------------*/

/* Under the lock: the next picture to send, when there is one that was not sent. */
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

/* Of a part of the client's text from `sent` on, as much as fits; how much. */
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

/* Called when the client's socket takes more. */
static ssize_t give(void *context, uint64_t position, char *to, size_t room)
{
    struct stream_client *client = context;
    struct stream *stream = client->stream;
    ssize_t given = 0;
    (void)position;
    pthread_mutex_lock(&stream->lock);
    if (stream->ending) {
        given = MHD_CONTENT_READER_END_OF_STREAM;
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

/* Under the lock. */
static struct stream_reply reply_stream(struct stream_client *client)
{
    struct stream *stream = client->stream;
    if (stream->watchers >= STREAM_WATCHERS)
        return stream_refuse(MHD_HTTP_SERVICE_UNAVAILABLE, "too many watch already\n");
    struct MHD_Response *response =
        MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, PART_BYTES, give, client, NULL);
    if (response == NULL)
        return (struct stream_reply){.waits = false};
    client->watching = true;
    stream->watchers++;
    client->view->watchers++;
    pthread_cond_signal(&stream->come);
    return (struct stream_reply){.response = response, .status = MHD_HTTP_OK, .type = MULTIPART};
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

/* Under the lock. */
static struct stream_reply reply_path(struct stream_client *client, const char *path)
{
    struct stream *stream = client->stream;
    size_t stem = 0, length = strnlen(path, REQUEST_BYTES);
    if (strcmp(path, "/") == 0)
        return reply_page(stream);
    if (strcmp(path, "/status.json") == 0)
        return reply_status(stream);
    if (strcmp(path, "/picture.jpg") == 0)
        return stream_asked_picture(client);
    if (strcmp(path, "/map.jpg") == 0 && stream->painter.paint != NULL &&
        (client->map != NULL ||
         MHD_get_connection_values(client->connection, MHD_GET_ARGUMENT_KIND, NULL, NULL) > 0))
        return stream_asked_map(client);
    bool live = length < REQUEST_BYTES && ends_with(path, length, ".mjpeg", &stem);
    bool still = length < REQUEST_BYTES && ends_with(path, length, ".jpg", &stem);
    if (live || still)
        client->view = stream_find(stream, path + 1, stem - 1);
    if (client->view == NULL)
        return stream_refuse(MHD_HTTP_NOT_FOUND, "there is /, /VIEW.mjpeg, /VIEW.jpg, "
                                                 "/picture.jpg?view=&vehicle=&size=, "
                                                 "/map.jpg?x=&z=&metres=&size=, /status.json\n");
    return live ? reply_stream(client) : reply_picture(client);
}

static struct stream_client *new_client(struct stream *stream, struct MHD_Connection *connection)
{
    struct stream_client *client = calloc(1, sizeof *client);
    if (client != NULL)
        *client = (struct stream_client){.stream = stream, .connection = connection};
    return client;
}

static enum MHD_Result on_request(void *context, struct MHD_Connection *connection,
                                  const char *path, const char *method, const char *version,
                                  const char *body, size_t *body_bytes, void **kept)
{
    const struct stream_door *door = context;
    struct stream *stream = door->stream;
    (void)version;
    (void)body;
    (void)body_bytes;
    struct stream_reply reply;
    const char *host =
        MHD_lookup_connection_value(connection, MHD_HEADER_KIND, MHD_HTTP_HEADER_HOST);
    if (strcmp(method, MHD_HTTP_METHOD_GET) != 0 && strcmp(method, MHD_HTTP_METHOD_HEAD) != 0) {
        reply = stream_refuse(MHD_HTTP_METHOD_NOT_ALLOWED, "pictures can only be looked at\n");
    } else if (door->local && !door->ours && host != NULL && !http_host_local(host)) {
        reply = stream_refuse(MHD_HTTP_FORBIDDEN, "ask by a name of this machine\n");
    } else if (*kept == NULL) {
        /* An answer to the first call would close the connection after it; there is another. */
        *kept = new_client(stream, connection);
        return *kept != NULL ? MHD_YES : MHD_NO;
    } else {
        pthread_mutex_lock(&stream->lock);
        reply = reply_path(*kept, path);
        pthread_mutex_unlock(&stream->lock);
    }
    return send_reply(connection, &reply);
}

static void on_end(void *context, struct MHD_Connection *connection, void **kept,
                   enum MHD_RequestTerminationCode why)
{
    const struct stream_door *door = context;
    struct stream *stream = door->stream;
    struct stream_client *client = *kept;
    (void)connection;
    (void)why;
    if (client == NULL)
        return;
    pthread_mutex_lock(&stream->lock);
    CHECK(!client->suspended);
    stream_asked_end(client);
    if (client->watching) {
        stream->watchers--;
        client->view->watchers--;
    }
    stream_release(client->jpeg);
    pthread_mutex_unlock(&stream->lock);
    free(client);
    *kept = NULL;
}

/* Any user may connect to an abstract socket: those of others are sent away at once, so that they
 * take nobody's place. */
static void on_connection(void *context, struct MHD_Connection *connection, void **kept,
                          enum MHD_ConnectionNotificationCode what)
{
    const struct stream_door *door = context;
    (void)kept;
    if (what != MHD_CONNECTION_NOTIFY_STARTED || !door->ours)
        return;
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    if (info != NULL && !pictures_peer_is(info->connect_fd, door->user))
        shutdown(info->connect_fd, SHUT_RDWR);
}

int stream_http_start(struct stream *stream)
{
    for (uint32_t i = 0; i < stream->doors; i++) {
        struct stream_door *door = &stream->door[i];
        door->daemon = MHD_start_daemon(
            MHD_USE_POLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME, 0, NULL, NULL, on_request,
            door, MHD_OPTION_LISTEN_SOCKET, door->listener, MHD_OPTION_CONNECTION_LIMIT,
            STREAM_CLIENTS, MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)PATIENCE_S,
            MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)MEMORY_BYTES, MHD_OPTION_NOTIFY_COMPLETED,
            on_end, door, MHD_OPTION_NOTIFY_CONNECTION, on_connection, door, MHD_OPTION_END);
        if (door->daemon == NULL)
            return -1;
        door->listener = -1; /* the daemon's to close */
    }
    return 0;
}

void stream_http_end(struct stream *stream)
{
    pthread_mutex_lock(&stream->lock);
    stream->ending = true;
    stream_http_wake(stream, NULL);
    pthread_mutex_unlock(&stream->lock);
    for (uint32_t i = 0; i < stream->doors; i++) {
        if (stream->door[i].daemon != NULL)
            MHD_stop_daemon(stream->door[i].daemon);
        stream->door[i].daemon = NULL;
    }
}
