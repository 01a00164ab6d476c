/* Executes POST requests. */
#include "clients/console/post_requests.h"

#include "clients/console/access_control.h"
#include "clients/console/process_control.h"
#include "ipc/process/clock.h"
#include "world/earth_location.h"

#include <stddef.h>
#include <string.h>

/* Called by the main thread when the command is done: the server then continues the request. */
static void on_ready(struct pending_command *pending)
{
    struct request *request =
        (struct request *)(void *)((char *)pending - offsetof(struct request, pending));
    http_wake(request->http);
}

static bool join(struct request *request, struct player *player, struct http_answer *answer)
{
    char name[PLAYERS_NAME_MAX];
    uint8_t key[SESSION_KEY_BYTES];
    struct json_writer *json = &answer->json;
    uint64_t source = command_client_source(), now_ns = clock_now_ns();
    (void)player;
    if (!request_body_join(name, request->http->body, request->http->body_bytes, answer))
        return true;
    if (source == 0 || !session_key_random(key)) {
        http_answer_error(answer, HTTP_ANSWER_AWAY, "try again",
                          "the system gives no random numbers");
        return true;
    }
    const struct player *joined =
        players_join(&request->console->players, name, key, source, now_ns);
    if (!joined) {
        http_answer_error(answer, HTTP_ANSWER_TOO_MANY, "wait until a player has left, or watch",
                          "there are %u players already", PLAYERS_MAX);
        return true;
    }
    json_writer_begin(json, '{');
    json_writer_key_whole(json, "player", joined->number);
    json_writer_key_word(json, "name", joined->name);
    json_writer_key_word(json, "key", joined->key);
    json_writer_end(json, '}');
    return true;
}

static bool command(struct request *request, struct player *player, struct http_answer *answer)
{
    struct console *console = request->console;
    struct pending_command *pending = &request->pending;
    const char *key = http_header(request->http, "X-Jolon-Player");
    struct location_frame frame;
    struct error_text error;
    if (key && !player) {
        http_answer_error(answer, HTTP_ANSWER_UNAUTHORIZED, "POST /api/join again",
                          "no player has this key; a player without requests for two minutes is "
                          "removed");
        return true;
    }
    if (console->ending || !console->reader.attached) {
        http_answer_error(answer, HTTP_ANSWER_AWAY, "wait until it is there", "%s",
                          console->ending ? "the console ends" : console->reader.detail.text);
        return true;
    }
    if (!request_body_order(&pending->order, &pending->cancel, request->http->body,
                            request->http->body_bytes, answer))
        return true;
    earth_location_frame(&frame, console->reader.view.world.params,
                         console->reader.view.world.terrain.squares.world_m);
    if (command_text_place(&pending->order, &frame, &error) != 0) {
        http_answer_error(answer, HTTP_ANSWER_BAD, "name a place within the world", "%s: %s",
                          pending->order.verb->name, error.text);
        return true;
    }
    pending->ready = on_ready;
    return !command_queue_put(&console->queue, pending, player, clock_now_ns(), answer);
}

static bool process(struct request *request, struct player *player, struct http_answer *answer)
{
    char role[REQUEST_BODY_ROLE_MAX];
    bool restart;
    (void)player;
    if (request_body_process(&restart, role, request->http->body, request->http->body_bytes,
                             answer))
        process_control_end(&request->console->reader, role, restart, answer);
    return true;
}

static const struct {
    const char *path;
    bool (*handle)(struct request *request, struct player *player, struct http_answer *answer);
} post_requests[] = {{"/api/join", join}, {"/api/command", command}, {"/api/process", process}};

#define POST_REQUESTS_COUNT (sizeof post_requests / sizeof post_requests[0])

bool post_requests_find(const char *path)
{
    for (size_t i = 0; i < POST_REQUESTS_COUNT; i++) {
        if (strcmp(path, post_requests[i].path) == 0)
            return true;
    }
    return false;
}

bool post_requests_handle(struct request *request, const char *path, struct http_answer *answer)
{
    uint64_t now_ns = clock_now_ns();
    struct player *player = access_control_player(request, now_ns);
    size_t i = 0;
    if (!access_control_open_to_change(request, player, now_ns, answer))
        return true;
    while (strcmp(path, post_requests[i].path) != 0)
        i++;
    return post_requests[i].handle(request, player, answer);
}
