/* Checks of a request, before anything is done. */
#include "clients/console/access_control.h"

#include "ipc/http/host_check.h"

#include <string.h>
#include <strings.h>

#define CHANGES_PER_S 100u /* requests a second of one player ... */
#define OTHERS_PER_S  50u  /* ... and of all clients without a player's key together */

#define BEARER "Bearer "

struct player *access_control_player(struct request *request, uint64_t now_ns)
{
    const char *key = http_header(request->http, "X-Jolon-Player");
    struct player *player = key ? players_find(&request->console->players, key) : NULL;
    if (player)
        player->last_request_ns = now_ns;
    return player;
}

/* Browsers send the origin of a request. Requests of another site's page are refused. */
static bool is_same_site(const struct request *request)
{
    const char *host = http_header(request->http, "Host");
    const char *origin = http_header(request->http, "Origin");
    const char *site = http_header(request->http, "Sec-Fetch-Site");
    return (!origin || (host && http_origin_is(origin, host))) &&
           (!site || strcmp(site, "same-origin") == 0 || strcmp(site, "none") == 0);
}

static bool refuse_rate(struct http_answer *answer)
{
    http_answer_error(answer, HTTP_ANSWER_TOO_MANY, "wait a second, then ask less often",
                      "too many requests");
    return false;
}

bool access_control_open(struct request *request, const struct player *player, uint64_t now_ns,
                         struct http_answer *answer)
{
    if (!is_same_site(request)) {
        http_answer_error(answer, HTTP_ANSWER_FORBIDDEN, "open the console's own page",
                          "a page of another site may not send requests");
        return false;
    }
    /* Each player has a separate rate, which spectators at the same address do not use up. */
    return http_may_ask(request->http, player != NULL, now_ns) || refuse_rate(answer);
}

static bool is_json(const char *type)
{
    static const char json[] = "application/json";
    return type && strncasecmp(type, json, sizeof json - 1) == 0 &&
           (type[sizeof json - 1] == '\0' || type[sizeof json - 1] == ';' ||
            type[sizeof json - 1] == ' ');
}

static bool has_token(const struct request *request)
{
    const char *given = http_header(request->http, "Authorization");
    return given && strncmp(given, BEARER, sizeof BEARER - 1) == 0 &&
           session_key_equal(request->console->token, given + sizeof BEARER - 1);
}

bool access_control_open_to_change(struct request *request, struct player *player, uint64_t now_ns,
                                   struct http_answer *answer)
{
    if (!access_control_open(request, player, now_ns, answer))
        return false;
    if (!has_token(request)) {
        http_answer_error(answer, HTTP_ANSWER_UNAUTHORIZED,
                          "open the address as the console printed it, with its #token=...",
                          "without the token the world can be seen, but not changed");
        return false;
    }
    if (!is_json(http_header(request->http, "Content-Type"))) {
        http_answer_error(answer, HTTP_ANSWER_NOT_JSON, "send Content-Type: application/json",
                          "the body must be declared as JSON");
        return false;
    }
    if (request->http->body_bytes > REQUEST_BODY) {
        http_answer_error(answer, HTTP_ANSWER_TOO_LARGE, "send a shorter body",
                          "the body has more than %u bytes", REQUEST_BODY);
        return false;
    }
    return (player
                ? rate_take(&player->rate, CHANGES_PER_S, CHANGES_PER_S, now_ns)
                : rate_take(&request->console->write_rate, OTHERS_PER_S, OTHERS_PER_S, now_ns)) ||
           refuse_rate(answer);
}
