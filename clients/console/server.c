/* Checks the requests and passes them to the functions that answer them. */
#include "clients/console/server.h"

#include "clients/console/post_requests.h"
#include "clients/console/access_control.h"
#include "clients/console/page_files.h"
#include "clients/console/events_json.h"
#include "clients/console/process_control.h"
#include "clients/console/state_json.h"
#include "clients/console/vehicles_json.h"
#include "clients/console/world_json.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define JSON_TYPE "application/json"

static const struct http_header headers[] = {
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Content-Security-Policy",
     "default-src 'self'; img-src 'self' blob: data:; object-src 'none'; base-uri 'none'; "
     "form-action 'none'; frame-ancestors 'none'"},
    {NULL, NULL},
};

/* --- answers -----------------------------------------------------------------------------------*/

/* Moves the answer's JSON to the reply. */
static void reply_answer(struct http_reply *reply, struct http_answer *answer)
{
    if (answer->json.failed || answer->json.used == 0)
        http_answer_error(answer, HTTP_ANSWER_AWAY, "ask for less, or again",
                          "no memory for the answer");
    *reply = (struct http_reply){.status = (unsigned)answer->status,
                                 .type = JSON_TYPE,
                                 .bytes = answer->json.bytes,
                                 .count = answer->json.used,
                                 .release = free,
                                 .owner = answer->json.bytes};
}

static void refuse(struct http_reply *reply, unsigned status, const char *what, const char *next)
{
    struct http_answer answer = {.status = HTTP_ANSWER_OK};
    http_answer_error(&answer, (enum http_answer_status)status, next, "%s", what);
    reply_answer(reply, &answer);
}

static void detach(void *copy)
{
    picture_proxy_release(copy);
}

/* Moves the picture to the reply. */
static void reply_picture(struct http_reply *reply, struct request *request)
{
    struct picture_copy *copy = request->waiter.copy;
    struct http_answer answer = {.status = HTTP_ANSWER_OK};
    request->waiter.copy = NULL;
    if (!copy || copy->status != HTTP_ANSWER_OK) {
        picture_proxy_explain(copy, &answer);
        picture_proxy_release(copy);
        reply_answer(reply, &answer);
        return;
    }
    *reply = (struct http_reply){.status = HTTP_ANSWER_OK,
                                 .type = "image/jpeg",
                                 .bytes = copy->body,
                                 .count = copy->body_bytes,
                                 .release = detach,
                                 .owner = copy};
    http_reply_add(reply, "X-Picture", "%llu", (unsigned long long)copy->number);
    http_reply_add(reply, "X-Frame", "%s", copy->frame);
    http_reply_add(reply, "X-Time", "%s", copy->time);
}

static void reply_page(struct http_reply *reply, const struct page_files_file *file)
{
    *reply = (struct http_reply){.status = HTTP_ANSWER_OK,
                                 .type = page_files_type(file),
                                 .cache = "no-cache",
                                 .bytes = file->bytes,
                                 .count = file->count};
}

/* --- GET requests ------------------------------------------------------------------------------*/

typedef void answer_function(const struct world_query *query, struct http_answer *answer);

static const struct {
    const char *path;
    answer_function *answer;
} get_requests[] = {
    {"/api/world", world_json},       {"/api/state", state_json},
    {"/api/list", vehicles_json},     {"/api/events", events_json},
    {"/api/place", world_json_place}, {"/api/processes", process_control_list},
};

static const char *argument(void *context, const char *key)
{
    return http_argument(context, key);
}

static answer_function *find_get_request(const char *path)
{
    for (size_t i = 0; i < sizeof get_requests / sizeof get_requests[0]; i++) {
        if (strcmp(path, get_requests[i].path) == 0)
            return get_requests[i].answer;
    }
    return NULL;
}

/* Called by a thread of the proxy: the server then continues the request. The lock makes sure that
 * the request is suspended first. */
static void on_picture(struct picture_waiter *waiter)
{
    struct request *request =
        (struct request *)(void *)((char *)waiter - offsetof(struct request, waiter));
    struct console *console = request->console;
    pthread_mutex_lock(&console->lock);
    http_wake(request->http);
    pthread_mutex_unlock(&console->lock);
}

/* Called under the lock. Returns false if the request waits for its picture; it is then called
 * again. */
static bool read_picture(struct request *request, bool map, struct http_answer *answer)
{
    char target[PICTURE_PROXY_TARGET];
    uint64_t now_ns = clock_now_ns();
    const struct player *player = access_control_player(request, now_ns);
    const struct query query = {argument, request->http};
    request->waiter.ready = on_picture;
    return !access_control_open(request, player, now_ns, answer) ||
           !picture_proxy_target(&query, map, target, &request->waiter, answer) ||
           picture_proxy_ask(&request->console->proxy, target, &request->waiter, answer);
}

/* Called under the lock. */
static void read_world(struct request *request, const char *path, struct http_answer *answer)
{
    struct console *console = request->console;
    uint64_t now_ns = clock_now_ns();
    const struct player *player = access_control_player(request, now_ns);
    answer_function *function = find_get_request(path);
    struct world_query query = {.reader = &console->reader,
                                .players = &console->players,
                                .queue = &console->queue,
                                .player = player,
                                .arguments = {argument, request->http},
                                .now_ns = now_ns};
    if (!access_control_open(request, player, now_ns, answer))
        return;
    if (function)
        function(&query, answer);
    else if (!page_files_find(path))
        http_answer_error(answer, HTTP_ANSWER_NOT_FOUND,
                          "the page is at /; docs/console.md lists the other paths",
                          "there is nothing at %.60s", path);
}

/* --- the server's calls ------------------------------------------------------------------------*/

/* Called under the lock. Returns true with the answer; false if the request waits for its command
 * or picture; it is then called again. */
static bool make_answer(struct request *request, const char *path, const char *method,
                        struct http_answer *answer)
{
    bool reads = strcmp(method, "GET") == 0 || strcmp(method, "HEAD") == 0;
    bool map = strcmp(path, "/api/map") == 0;
    if (request->waiter.done)
        return true;
    if (request->pending.done) {
        *answer = request->pending.answer;
        request->pending.answer = (struct http_answer){.status = HTTP_ANSWER_OK};
        return true;
    }
    if (reads && (map || strcmp(path, "/api/picture") == 0))
        return read_picture(request, map, answer);
    if (reads && !post_requests_find(path))
        read_world(request, path, answer);
    else if (!reads && strcmp(method, "POST") == 0 && post_requests_find(path))
        return post_requests_handle(request, path, answer);
    else
        http_answer_error(answer, HTTP_ANSWER_NOT_ALLOWED,
                          post_requests_find(path) ? "POST it" : "GET it", "%.20s is not for %.60s",
                          method, path);
    return true;
}

static bool on_request(void *context, struct http_request *http, struct http_reply *reply)
{
    struct console *console = context;
    struct request *request = http->own;
    struct http_answer answer = {.status = HTTP_ANSWER_OK};
    if (!http->woken)
        *request = (struct request){
            .console = console, .http = http, .pending = {.answer = {.status = HTTP_ANSWER_OK}}};
    pthread_mutex_lock(&console->lock);
    bool now = make_answer(request, http->path, http->method, &answer);
    if (!now)
        http_wait(http);
    pthread_mutex_unlock(&console->lock);
    if (!now)
        return false;
    const struct page_files_file *file = answer.json.used == 0 ? page_files_find(http->path) : NULL;
    if (request->waiter.done)
        reply_picture(reply, request);
    else if (file)
        reply_page(reply, file);
    else
        reply_answer(reply, &answer);
    return true;
}

static void on_end(void *context, struct http_request *http)
{
    struct request *request = http->own;
    (void)context;
    json_writer_free(&request->pending.answer.json);
    picture_proxy_release(request->waiter.copy);
}

int server_start(struct console *console, struct error_text *error)
{
    const struct http_handler handler = {.context = console,
                                         .own_bytes = sizeof(struct request),
                                         .body_max = REQUEST_BODY,
                                         .headers = headers,
                                         .answer = on_request,
                                         .refuse = refuse,
                                         .end = on_end};
    console->http = http_server_start(&console->listener, &handler, error);
    return console->http ? 0 : -1;
}

void server_end(struct console *console)
{
    pthread_mutex_lock(&console->lock);
    console->ending = true;
    command_queue_close(&console->queue);
    pthread_mutex_unlock(&console->lock);
    picture_proxy_close(&console->proxy);
    http_server_stop(console->http);
}
