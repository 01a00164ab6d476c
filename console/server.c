/* Requests: their checks, and who answers them. */
#include "console/server.h"

#include "console/change.h"
#include "console/gate.h"
#include "console/page.h"
#include "console/tell.h"
#include "ipc/clock.h"
#include "ipc/log.h"

#include <errno.h>
#include <microhttpd.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PATIENCE_S    10    /* with a client that neither reads nor asks */
#define MEMORY_BYTES  16384 /* of a connection: the request's line and head, the answer's head */
#define PER_ADDRESS   64u   /* connections; not on loopback, where all have the same address */
#define PER_SEAT_S    200u  /* requests a second of one connection, ... */
#define PER_ADDRESS_S 1500u /* ... and of one address */

#define JSON_TYPE "application/json"
#define POLICY                                                                                     \
    "default-src 'self'; img-src 'self' blob: data:; object-src 'none'; base-uri 'none'; "         \
    "form-action 'none'; frame-ancestors 'none'"

/* --- answers -----------------------------------------------------------------------------------*/

static enum MHD_Result queue(struct MHD_Connection *connection, struct MHD_Response *response,
                             unsigned status, const char *type, const char *cache)
{
    if (!response)
        return MHD_NO;
    (void)MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, type);
    (void)MHD_add_response_header(response, MHD_HTTP_HEADER_CACHE_CONTROL, cache);
    (void)MHD_add_response_header(response, "X-Content-Type-Options", "nosniff");
    (void)MHD_add_response_header(response, "X-Frame-Options", "DENY");
    (void)MHD_add_response_header(response, "Referrer-Policy", "no-referrer");
    (void)MHD_add_response_header(response, "Cross-Origin-Resource-Policy", "same-origin");
    (void)MHD_add_response_header(response, "Content-Security-Policy", POLICY);
    enum MHD_Result result = MHD_queue_response(connection, status, response);
    MHD_destroy_response(response);
    return result;
}

/* The answer's text becomes libmicrohttpd's. */
static enum MHD_Result send_answer(struct MHD_Connection *connection, struct answer *answer)
{
    if (answer->text.failed || answer->text.used == 0)
        answer_error(answer, ANSWER_AWAY, "ask for less, or again", "no memory for the answer");
    struct MHD_Response *response = MHD_create_response_from_buffer(
        answer->text.used, answer->text.bytes, MHD_RESPMEM_MUST_FREE);
    if (!response)
        text_free(&answer->text);
    return queue(connection, response, (unsigned)answer->status, JSON_TYPE, "no-store");
}

static void let_go(void *copy)
{
    pictures_release(copy);
}

/* The copy becomes libmicrohttpd's. */
static enum MHD_Result send_picture(struct request *request)
{
    struct picture_copy *copy = request->gaze.copy;
    struct answer answer = {.status = ANSWER_OK};
    union {
        const void *bytes;
        void *kept; /* it is not written to */
    } body;
    char number[24];
    request->gaze.copy = NULL;
    if (!copy || copy->status != MHD_HTTP_OK) {
        pictures_explain(copy, &answer);
        pictures_release(copy);
        return send_answer(request->connection, &answer);
    }
    body.bytes = copy->body;
    struct MHD_Response *response = MHD_create_response_from_buffer_with_free_callback_cls(
        copy->body_bytes, body.kept, let_go, copy);
    if (!response) {
        pictures_release(copy);
        return MHD_NO;
    }
    (void)snprintf(number, sizeof number, "%llu", (unsigned long long)copy->number);
    (void)MHD_add_response_header(response, "X-Picture", number);
    (void)MHD_add_response_header(response, "X-Frame", copy->frame);
    (void)MHD_add_response_header(response, "X-Time", copy->time);
    return queue(request->connection, response, MHD_HTTP_OK, "image/jpeg", "no-store");
}

static enum MHD_Result send_page(struct MHD_Connection *connection, const struct page_file *file)
{
    union {
        const void *bytes;
        void *kept; /* it is not written to */
    } body = {file->bytes};
    return queue(connection,
                 MHD_create_response_from_buffer(file->count, body.kept, MHD_RESPMEM_PERSISTENT),
                 MHD_HTTP_OK, page_type(file), "no-cache");
}

/* --- what there is to ask for ------------------------------------------------------------------*/

typedef void tell_function(const struct tell *tell, struct answer *answer);

static const struct {
    const char *path;
    tell_function *tell;
} readings[] = {
    {"/api/world", tell_world},   {"/api/state", tell_state},         {"/api/list", tell_list},
    {"/api/events", tell_events}, {"/api/processes", tell_processes},
};

static const char *argument(void *context, const char *key)
{
    return MHD_lookup_connection_value(context, MHD_GET_ARGUMENT_KIND, key);
}

static tell_function *find_reading(const char *path)
{
    for (size_t i = 0; i < sizeof readings / sizeof readings[0]; i++) {
        if (strcmp(path, readings[i].path) == 0)
            return readings[i].tell;
    }
    return NULL;
}

/* From a thread of the pictures': the server goes on with the request, once it is suspended. */
static void on_picture(struct gaze *gaze)
{
    struct request *request =
        (struct request *)(void *)((char *)gaze - offsetof(struct request, gaze));
    struct console *console = request->console;
    pthread_mutex_lock(&console->lock);
    MHD_resume_connection(request->connection);
    pthread_mutex_unlock(&console->lock);
}

/* Under the lock. False: it waits for its picture, and is called again. */
static bool read_picture(struct request *request, bool map, struct answer *answer)
{
    char target[PICTURES_TARGET];
    uint64_t now_ns = clock_now_ns();
    const struct player *player = gate_player(request, now_ns);
    const struct query query = {argument, request->connection};
    request->gaze.ready = on_picture;
    return !gate_open(request, player, now_ns, answer) ||
           !pictures_target(&query, map, target, &request->gaze, answer) ||
           pictures_ask(&request->console->pictures, target, &request->gaze, answer);
}

/* Under the lock. */
static void read_world(struct request *request, const char *path, struct answer *answer)
{
    struct console *console = request->console;
    uint64_t now_ns = clock_now_ns();
    const struct player *player = gate_player(request, now_ns);
    tell_function *function = find_reading(path);
    struct tell tell = {.watch = &console->watch,
                        .players = &console->players,
                        .desk = &console->desk,
                        .player = player,
                        .query = {argument, request->connection},
                        .now_ns = now_ns};
    if (!gate_open(request, player, now_ns, answer))
        return;
    if (function)
        function(&tell, answer);
    else if (!page_find(path))
        answer_error(answer, ANSWER_NOT_FOUND,
                     "the page begins at /; docs/console.md lists the "
                     "rest",
                     "there is nothing at %.60s", path);
}

/* --- libmicrohttpd's calls ---------------------------------------------------------------------*/

/* Under the lock: what is answered now; false: it waits for its ticket, and is called again. */
static bool make_answer(struct request *request, const char *path, const char *method,
                        struct answer *answer)
{
    bool reads =
        strcmp(method, MHD_HTTP_METHOD_GET) == 0 || strcmp(method, MHD_HTTP_METHOD_HEAD) == 0;
    bool map = strcmp(path, "/api/map") == 0;
    if (request->gaze.done)
        return true;
    if (request->ticket.done) {
        *answer = request->ticket.answer;
        request->ticket.answer = (struct answer){.status = ANSWER_OK};
        return true;
    }
    if (request->seat)
        crowd_begin(request->seat, clock_now_ns());
    if (reads && (map || strcmp(path, "/api/picture") == 0))
        return read_picture(request, map, answer);
    if (reads && !change_find(path))
        read_world(request, path, answer);
    else if (!reads && strcmp(method, MHD_HTTP_METHOD_POST) == 0 && change_find(path))
        return change_world(request, path, answer);
    else
        answer_error(answer, ANSWER_NOT_ALLOWED,
                     change_find(path) ? "POST it" : "GET it; nothing else is to be had here",
                     "%.20s is not for %.60s", method, path);
    return true;
}

static enum MHD_Result answer_request(struct request *request, const char *path, const char *method)
{
    struct answer answer = {.status = ANSWER_OK};
    struct console *console = request->console;
    pthread_mutex_lock(&console->lock);
    bool now = make_answer(request, path, method, &answer);
    if (!now)
        MHD_suspend_connection(request->connection);
    pthread_mutex_unlock(&console->lock);
    if (!now)
        return MHD_YES;
    if (request->gaze.done)
        return send_picture(request);
    const struct page_file *file = answer.text.used == 0 ? page_find(path) : NULL;
    return file ? send_page(request->connection, file) : send_answer(request->connection, &answer);
}

static struct request *new_request(struct console *console, struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    struct request *request = calloc(1, sizeof *request);
    if (request)
        *request = (struct request){.console = console,
                                    .connection = connection,
                                    .seat = info ? info->socket_context : NULL,
                                    .ticket = {.answer = {.status = ANSWER_OK}}};
    return request;
}

/* A longer body is read to its end, so that its sender hears why it is not taken. */
static void take_body(struct request *request, const char *bytes, size_t count)
{
    size_t fits = request->body_bytes < REQUEST_BODY ? REQUEST_BODY - request->body_bytes : 0;
    memcpy(request->body + (REQUEST_BODY - fits), bytes, count < fits ? count : fits);
    request->body_bytes += count;
}

static enum MHD_Result on_request(void *context, struct MHD_Connection *connection,
                                  const char *path, const char *method, const char *version,
                                  const char *body, size_t *body_bytes, void **kept)
{
    (void)version;
    struct request *request = *kept;
    if (!request) {
        *kept = request = new_request(context, connection);
        return request ? MHD_YES : MHD_NO;
    }
    if (*body_bytes > 0) {
        take_body(request, body, *body_bytes);
        *body_bytes = 0;
        return MHD_YES;
    }
    return answer_request(request, path, method);
}

static void on_end(void *context, struct MHD_Connection *connection, void **kept,
                   enum MHD_RequestTerminationCode why)
{
    struct console *console = context;
    struct request *request = *kept;
    (void)connection;
    (void)why;
    if (!request)
        return;
    pthread_mutex_lock(&console->lock);
    if (request->seat)
        crowd_done(request->seat, clock_now_ns());
    pthread_mutex_unlock(&console->lock);
    text_free(&request->ticket.answer.text);
    pictures_release(request->gaze.copy);
    free(request);
    *kept = NULL;
}

static void on_connection(void *context, struct MHD_Connection *connection, void **seat,
                          enum MHD_ConnectionNotificationCode what)
{
    struct console *console = context;
    pthread_mutex_lock(&console->lock);
    if (what == MHD_CONNECTION_NOTIFY_STARTED) {
        const union MHD_ConnectionInfo *info =
            MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
        *seat = crowd_come(&console->crowd, info->connect_fd, clock_now_ns());
    } else if (*seat) {
        crowd_leave(&console->crowd, *seat);
    }
    pthread_mutex_unlock(&console->lock);
}

int server_start(struct console *console, struct reason *reason)
{
    sigset_t all, before;
    /* Signals are the first thread's. */
    sigfillset(&all);
    sigdelset(&all, SIGSYS); /* what the sandbox forbids is to be told */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    console->daemon = MHD_start_daemon(
        MHD_USE_POLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME, 0, NULL, NULL, on_request, console,
        MHD_OPTION_LISTEN_SOCKET, console->listener.fd, MHD_OPTION_CONNECTION_LIMIT, CROWD_ROOM,
        MHD_OPTION_PER_IP_CONNECTION_LIMIT, console->listener.local ? 0u : PER_ADDRESS,
        MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)PATIENCE_S, MHD_OPTION_CONNECTION_MEMORY_LIMIT,
        (size_t)MEMORY_BYTES, MHD_OPTION_NOTIFY_COMPLETED, on_end, console,
        MHD_OPTION_NOTIFY_CONNECTION, on_connection, console, MHD_OPTION_END);
    int cause = errno;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return console->daemon ? 0 : reason_set(reason, "cannot start the server: %s", strerror(cause));
}

void server_end(struct console *console)
{
    pthread_mutex_lock(&console->lock);
    console->ending = true;
    desk_close(&console->desk);
    pthread_mutex_unlock(&console->lock);
    pictures_close(&console->pictures);
    MHD_stop_daemon(console->daemon);
    console->daemon = NULL;
}
