/* Checks of a request, before anything is done. */
#include "console/gate.h"

#include "http/host.h"

#include <microhttpd.h>
#include <netinet/in.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>

#define PER_SEAT_S    200u  /* requests a second of one connection, ... */
#define PER_ADDRESS_S 1500u /* ... and of one address, players' apart */
#define CHANGES_S     100u  /* orders a second of a player, ... */
#define STRANGERS_S   50u   /* ... and of all who are none */

#define BEARER "Bearer "

const char *request_header(const struct request *request, const char *name)
{
    return MHD_lookup_connection_value(request->connection, MHD_HEADER_KIND, name);
}

struct player *gate_player(struct request *request, uint64_t now_ns)
{
    const char *key = request_header(request, "X-Jolon-Player");
    struct player *player = key ? players_find(&request->console->players, key) : NULL;
    if (player)
        player->heard_ns = now_ns;
    return player;
}

/* A name by which this server can be asked for: on loopback this machine's own; else also any
 * address in numbers, for no page elsewhere has one of those for a name. */
static bool host_ok(const struct console *console, const char *host)
{
    return http_host_local(host) || (!console->listener.local && http_host_numeric(host));
}

/* Browsers say from where they ask: another site's page is not answered, whatever it asks. */
static bool from_here(const struct request *request, const char *host)
{
    const char *origin = request_header(request, MHD_HTTP_HEADER_ORIGIN);
    const char *site = request_header(request, "Sec-Fetch-Site");
    return (!origin || http_origin_is(origin, host)) &&
           (!site || strcmp(site, "same-origin") == 0 || strcmp(site, "none") == 0);
}

static struct rate *address_rate(struct request *request)
{
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(request->connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
    uint32_t hash = 2166136261u;
    const uint8_t *bytes = NULL;
    size_t count = 0;
    if (info && info->client_addr->sa_family == AF_INET) {
        bytes = (const uint8_t *)&((const struct sockaddr_in *)(const void *)info->client_addr)
                    ->sin_addr;
        count = sizeof(struct in_addr);
    } else if (info && info->client_addr->sa_family == AF_INET6) {
        bytes = (const uint8_t *)&((const struct sockaddr_in6 *)(const void *)info->client_addr)
                    ->sin6_addr;
        count = 8; /* the network: a client has many addresses in it */
    }
    for (size_t i = 0; i < count; i++)
        hash = (hash ^ bytes[i]) * 16777619u;
    return &request->console->address_rate[hash % SERVER_ADDRESSES];
}

/* Players have a rate of their own: strangers at the same address take nothing from them. */
static bool rate_ok(struct request *request, const struct player *player, uint64_t now_ns)
{
    return (!request->seat || rate_take(&request->seat->rate, PER_SEAT_S, PER_SEAT_S, now_ns)) &&
           (player || rate_take(address_rate(request), PER_ADDRESS_S, PER_ADDRESS_S, now_ns));
}

static bool refuse_rate(struct answer *answer)
{
    answer_error(answer, ANSWER_TOO_MANY, "wait a second, then ask less often",
                 "too many requests");
    return false;
}

bool gate_open(struct request *request, const struct player *player, uint64_t now_ns,
               struct answer *answer)
{
    const char *host = request_header(request, MHD_HTTP_HEADER_HOST);
    if (!host || !host_ok(request->console, host)) {
        answer_error(answer, ANSWER_FORBIDDEN, "ask as the console printed its address",
                     "this is no name of this server");
        return false;
    }
    if (!from_here(request, host)) {
        answer_error(answer, ANSWER_FORBIDDEN, "open the console's own page",
                     "another site's page may ask nothing here");
        return false;
    }
    return rate_ok(request, player, now_ns) || refuse_rate(answer);
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
    const char *given = request_header(request, MHD_HTTP_HEADER_AUTHORIZATION);
    return given && strncmp(given, BEARER, sizeof BEARER - 1) == 0 &&
           secret_equal(request->console->token, given + sizeof BEARER - 1);
}

bool gate_open_to_change(struct request *request, struct player *player, uint64_t now_ns,
                         struct answer *answer)
{
    if (!gate_open(request, player, now_ns, answer))
        return false;
    if (!has_token(request)) {
        answer_error(answer, ANSWER_UNAUTHORIZED,
                     "open the address as the console printed it, with its #token=...",
                     "who has no token may only look");
        return false;
    }
    if (!is_json(request_header(request, MHD_HTTP_HEADER_CONTENT_TYPE))) {
        answer_error(answer, ANSWER_NOT_JSON, "send Content-Type: application/json",
                     "the body must be JSON, and say so");
        return false;
    }
    if (request->body_bytes > REQUEST_BODY) {
        answer_error(answer, ANSWER_TOO_LARGE, "an order is short", "more than %u bytes",
                     REQUEST_BODY);
        return false;
    }
    return (player ? rate_take(&player->rate, CHANGES_S, CHANGES_S, now_ns)
                   : rate_take(&request->console->write_rate, STRANGERS_S, STRANGERS_S, now_ns)) ||
           refuse_rate(answer);
}
