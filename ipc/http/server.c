/* Requests and answers, by libmicrohttpd. */
#include "ipc/http/server.h"

#include "ipc/http/connection_limit.h"
#include "ipc/http/host_check.h"
#include "ipc/process/clock.h"
#include "ipc/segment/local_socket.h"
#include "world/runtime/check.h"

#include <errno.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#define IDLE_TIMEOUT_S   10    /* for a client that neither reads nor sends a byte */
#define MEMORY_BYTES     16384 /* of a connection: the heads of request and answer */
#define PART_BYTES       65536 /* of an answer at a time */
#define PER_CONNECTION_S 200u  /* requests a second of one connection */
#define PER_ADDRESS_S    1500u /* ... of one address; not on loopback */
#define PER_ADDRESS      64u   /* connections of one address; not on loopback */
#define ADDRESSES        256u  /* rates, by a hash of the address */
#define STALL_NS         NS_PER_S

/* Descriptors: the wanted limit, those beside connections, and the fewest slots. */
#define FILES        1024u
#define FILES_OTHERS 64u
#define SLOTS_MIN    16u

struct http_server {
    struct http_handler handler;
    struct MHD_Daemon *daemon;
    bool local, unix_socket; /* of the listener */
    uid_t user;
    pthread_mutex_t lock; /* of all below; no other lock is taken under it */
    struct connection_limit limit;
    struct rate address_rate[ADDRESSES];
};

struct exchange {
    struct http_request request; /* first, so that a handler's pointer leads back to the exchange */
    struct http_server *server;
    struct MHD_Connection *connection;
    struct connection *slot;
    struct http_reply reply;
    char *body; /* [handler.body_max], behind own */
    max_align_t own[];
};

static struct exchange *exchange_of(struct http_request *request)
{
    return (struct exchange *)(void *)request;
}

static void note(struct exchange *exchange, enum connection_state state)
{
    pthread_mutex_lock(&exchange->server->lock);
    connection_note(exchange->slot, state, clock_now_ns());
    pthread_mutex_unlock(&exchange->server->lock);
}

/* --- for handlers ------------------------------------------------------------------------------*/

const char *http_header(struct http_request *request, const char *name)
{
    return MHD_lookup_connection_value(exchange_of(request)->connection, MHD_HEADER_KIND, name);
}

const char *http_argument(struct http_request *request, const char *key)
{
    return MHD_lookup_connection_value(exchange_of(request)->connection, MHD_GET_ARGUMENT_KIND,
                                       key);
}

struct taking {
    bool (*take)(void *context, const char *key, const char *value);
    void *context;
};

static enum MHD_Result take_argument(void *context, enum MHD_ValueKind kind, const char *key,
                                     const char *value)
{
    const struct taking *taking = context;
    (void)kind;
    return taking->take(taking->context, key, value) ? MHD_YES : MHD_NO;
}

int http_arguments(struct http_request *request,
                   bool (*take)(void *context, const char *key, const char *value), void *context)
{
    struct taking taking = {take, context};
    return MHD_get_connection_values(exchange_of(request)->connection, MHD_GET_ARGUMENT_KIND,
                                     take ? take_argument : NULL, &taking);
}

void http_wait(struct http_request *request)
{
    struct exchange *exchange = exchange_of(request);
    note(exchange, CONNECTION_WAITING);
    request->woken = true;
    MHD_suspend_connection(exchange->connection);
}

void http_wake(struct http_request *request)
{
    struct exchange *exchange = exchange_of(request);
    note(exchange, CONNECTION_ANSWERING);
    MHD_resume_connection(exchange->connection);
}

bool http_drop_stalled(struct http_request *request, uint64_t now_ns)
{
    struct exchange *exchange = exchange_of(request);
    pthread_mutex_lock(&exchange->server->lock);
    bool stalls = connection_stalls(exchange->slot, STALL_NS, now_ns);
    if (stalls)
        connection_shut(exchange->slot);
    pthread_mutex_unlock(&exchange->server->lock);
    return stalls;
}

/* --- how often ---------------------------------------------------------------------------------*/

static struct rate *address_rate(const struct exchange *exchange)
{
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(exchange->connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
    const struct sockaddr *address = info ? info->client_addr : NULL;
    const uint8_t *bytes = (const uint8_t *)address;
    uint32_t hash = 2166136261u;
    size_t count = 0;
    if (address && address->sa_family == AF_INET) {
        bytes += offsetof(struct sockaddr_in, sin_addr);
        count = sizeof(struct in_addr);
    } else if (address && address->sa_family == AF_INET6) {
        bytes += offsetof(struct sockaddr_in6, sin6_addr);
        count = 8; /* the network, in which a client has many addresses */
    }
    for (size_t i = 0; i < count; i++)
        hash = (hash ^ bytes[i]) * 16777619u;
    return &exchange->server->address_rate[hash % ADDRESSES];
}

bool http_may_ask(struct http_request *request, bool no_address_rate, uint64_t now_ns)
{
    struct exchange *exchange = exchange_of(request);
    struct rate *address = address_rate(exchange);
    pthread_mutex_lock(&exchange->server->lock);
    bool may = rate_take(&exchange->slot->rate, PER_CONNECTION_S, PER_CONNECTION_S, now_ns) &&
               (no_address_rate || exchange->server->local ||
                rate_take(address, PER_ADDRESS_S, PER_ADDRESS_S, now_ns));
    pthread_mutex_unlock(&exchange->server->lock);
    return may;
}

/* --- answers -----------------------------------------------------------------------------------*/

void http_reply_text(struct http_reply *reply, unsigned status, const char *type, const char *text)
{
    char *copy = strdup(text);
    *reply = (struct http_reply){.status = status,
                                 .type = type,
                                 .bytes = copy,
                                 .count = copy ? strlen(copy) : 0,
                                 .release = free,
                                 .owner = copy};
}

void http_reply_add(struct http_reply *reply, const char *name, const char *format, ...)
{
    va_list arguments;
    if (reply->headers >= HTTP_HEADERS_MAX)
        return;
    reply->header[reply->headers].name = name;
    va_start(arguments, format);
    (void)vsnprintf(reply->header[reply->headers].value, sizeof reply->header[0].value, format,
                    arguments);
    va_end(arguments);
    reply->headers++;
}

/* Called when the client's socket takes more, so the server knows that the client reads. */
static ssize_t give_part(void *context, uint64_t position, char *to, size_t room)
{
    struct exchange *exchange = context;
    const struct http_reply *reply = &exchange->reply;
    note(exchange, CONNECTION_ANSWERING);
    if (reply->give) {
        ssize_t given = reply->give(&exchange->request, to, room);
        return given >= 0 ? given : (ssize_t)MHD_CONTENT_READER_END_OF_STREAM;
    }
    size_t left = reply->count - (size_t)position, bytes = left < room ? left : room;
    memcpy(to, (const char *)reply->bytes + position, bytes);
    return (ssize_t)bytes;
}

static enum MHD_Result send_reply(struct exchange *exchange)
{
    const struct http_reply *reply = &exchange->reply;
    size_t part = reply->give || reply->count > PART_BYTES ? PART_BYTES : reply->count + 1;
    CHECK(reply->status >= 100);
    if (!reply->give && !reply->bytes)
        return MHD_NO; /* no memory */
    struct MHD_Response *response = MHD_create_response_from_callback(
        reply->give ? MHD_SIZE_UNKNOWN : reply->count, part, give_part, exchange, NULL);
    if (!response)
        return MHD_NO;
    (void)MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, reply->type);
    (void)MHD_add_response_header(response, MHD_HTTP_HEADER_CACHE_CONTROL,
                                  reply->cache ? reply->cache : "no-store");
    (void)MHD_add_response_header(response, "X-Content-Type-Options", "nosniff");
    for (const struct http_header *header = exchange->server->handler.headers; header->name;
         header++)
        (void)MHD_add_response_header(response, header->name, header->value);
    for (uint32_t i = 0; i < reply->headers; i++)
        (void)MHD_add_response_header(response, reply->header[i].name, reply->header[i].value);
    enum MHD_Result result = MHD_queue_response(exchange->connection, reply->status, response);
    MHD_destroy_response(response);
    return result;
}

/* --- libmicrohttpd's calls ---------------------------------------------------------------------*/

/* On loopback the server accepts this machine's own names, elsewhere also numeric addresses, which
 * no other page can have for a name. A page cannot reach a Unix socket. */
static bool host_ok(struct exchange *exchange)
{
    const char *host = http_header(&exchange->request, MHD_HTTP_HEADER_HOST);
    return exchange->server->unix_socket ||
           (host &&
            (http_host_local(host) || (!exchange->server->local && http_host_numeric(host))));
}

static enum MHD_Result answer(struct exchange *exchange)
{
    const struct http_handler *handler = &exchange->server->handler;
    note(exchange, CONNECTION_ANSWERING);
    if (!host_ok(exchange))
        handler->refuse(&exchange->reply, MHD_HTTP_FORBIDDEN, "this is no name of this server",
                        "ask by a name of this machine, or by its address in numbers");
    else if (!handler->answer(handler->context, &exchange->request, &exchange->reply))
        return MHD_YES;
    return send_reply(exchange);
}

static struct exchange *begin_exchange(struct http_server *server,
                                       struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    const struct http_handler *handler = &server->handler;
    if (!info || !info->socket_context) /* the connection was refused */
        return NULL;
    struct exchange *exchange =
        calloc(1, sizeof *exchange + handler->own_bytes + handler->body_max);
    if (!exchange)
        return NULL;
    exchange->server = server;
    exchange->connection = connection;
    exchange->slot = info->socket_context;
    exchange->body = (char *)exchange->own + handler->own_bytes;
    exchange->request.own = exchange->own;
    exchange->request.body = exchange->body;
    return exchange;
}

/* A body that is too long is read to its end, so that its sender gets the refusal. */
static void take_body(struct exchange *exchange, const char *bytes, size_t count)
{
    struct http_request *request = &exchange->request;
    size_t most = exchange->server->handler.body_max;
    size_t fits = request->body_bytes < most ? most - request->body_bytes : 0;
    memcpy(exchange->body + (most - fits), bytes, count < fits ? count : fits);
    request->body_bytes += count;
}

static enum MHD_Result on_request(void *context, struct MHD_Connection *connection,
                                  const char *path, const char *method, const char *version,
                                  const char *body, size_t *body_bytes, void **kept)
{
    struct exchange *exchange = *kept;
    (void)version;
    if (!exchange) {
        /* An answer in the first call would close the connection after it. A second call
         * follows. */
        *kept = exchange = begin_exchange(context, connection);
        return exchange ? MHD_YES : MHD_NO;
    }
    if (*body_bytes > 0) {
        take_body(exchange, body, *body_bytes);
        *body_bytes = 0;
        return MHD_YES;
    }
    exchange->request.path = path;
    exchange->request.method = method;
    return answer(exchange);
}

static void on_end(void *context, struct MHD_Connection *connection, void **kept,
                   enum MHD_RequestTerminationCode detail)
{
    struct http_server *server = context;
    struct exchange *exchange = *kept;
    (void)connection;
    (void)detail;
    if (!exchange)
        return;
    server->handler.end(server->handler.context, &exchange->request);
    if (exchange->reply.release)
        exchange->reply.release(exchange->reply.owner);
    note(exchange, CONNECTION_ASKING);
    free(exchange);
    *kept = NULL;
}

/* A connection of another user to a Unix socket is shut at once and gets no slot. */
static void on_connection(void *context, struct MHD_Connection *connection, void **slot,
                          enum MHD_ConnectionNotificationCode what)
{
    struct http_server *server = context;
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    pthread_mutex_lock(&server->lock);
    if (what == MHD_CONNECTION_NOTIFY_STARTED) {
        *slot = !server->unix_socket || local_socket_peer_is(info->connect_fd, server->user)
                    ? connection_come(&server->limit, info->connect_fd, clock_now_ns())
                    : NULL;
        if (!*slot)
            (void)shutdown(info->connect_fd, SHUT_RDWR);
    } else if (*slot) {
        connection_leave(&server->limit, *slot);
    }
    pthread_mutex_unlock(&server->lock);
}

/* --- starting and ending -----------------------------------------------------------------------*/

/* Returns the number of slots, so that two servers and the rest of the process have descriptors; 0
 * with the reason when there are too few. */
static uint32_t count_slots(struct error_text *error)
{
    struct rlimit files;
    if (getrlimit(RLIMIT_NOFILE, &files) != 0) {
        error_text_set(error, "cannot read the limit of open files: %s", strerror(errno));
        return 0;
    }
    if (files.rlim_cur < FILES) {
        files.rlim_cur = files.rlim_max < FILES ? files.rlim_max : FILES;
        (void)setrlimit(RLIMIT_NOFILE, &files); /* raising the soft limit is always allowed */
    }
    uint32_t most = files.rlim_cur < FILES ? (uint32_t)files.rlim_cur : FILES;
    uint32_t slots = most > FILES_OTHERS ? (most - FILES_OTHERS) / 3 : 0;
    if (slots < SLOTS_MIN) {
        error_text_set(error, "only %u files may be open; a server of HTTP needs %u (ulimit -n)",
                       most, FILES_OTHERS + 3 * SLOTS_MIN);
        return 0;
    }
    return slots < CONNECTION_SLOTS_MAX ? slots : CONNECTION_SLOTS_MAX;
}

static struct MHD_Daemon *start_daemon(struct http_server *server, int fd)
{
    sigset_t all, before;
    /* Signals are for the first thread. */
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    struct MHD_Daemon *daemon = MHD_start_daemon(
        MHD_USE_POLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME, 0, NULL, NULL, on_request, server,
        MHD_OPTION_LISTEN_SOCKET, fd, MHD_OPTION_CONNECTION_LIMIT,
        CONNECTION_ROOM(server->limit.slots), MHD_OPTION_PER_IP_CONNECTION_LIMIT,
        server->local ? 0u : PER_ADDRESS, MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)IDLE_TIMEOUT_S,
        MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)MEMORY_BYTES, MHD_OPTION_NOTIFY_COMPLETED,
        on_end, server, MHD_OPTION_NOTIFY_CONNECTION, on_connection, server, MHD_OPTION_END);
    int cause = errno;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = cause;
    return daemon;
}

struct http_server *http_server_start(struct http_listener *listener,
                                      const struct http_handler *handler, struct error_text *error)
{
    uint32_t slots = count_slots(error);
    struct http_server *server = slots > 0 ? calloc(1, sizeof *server) : NULL;
    if (!server) {
        if (slots > 0)
            error_text_set(error, "no memory for a server of HTTP");
        return NULL;
    }
    server->handler = *handler;
    server->local = listener->local;
    server->unix_socket = listener->unix_socket;
    server->user = geteuid();
    server->limit.slots = slots;
    pthread_mutex_init(&server->lock, NULL);
    server->daemon = start_daemon(server, listener->fd);
    if (server->daemon) {
        listener->fd = -1;
        return server;
    }
    error_text_set(error, "cannot start the server of HTTP: %s", strerror(errno));
    http_server_stop(server);
    return NULL;
}

void http_server_stop(struct http_server *server)
{
    if (!server)
        return;
    if (server->daemon)
        MHD_stop_daemon(server->daemon);
    pthread_mutex_destroy(&server->lock);
    free(server);
}

void http_server_sweep(struct http_server *server, uint64_t now_ns)
{
    pthread_mutex_lock(&server->lock);
    connection_sweep(&server->limit, now_ns);
    pthread_mutex_unlock(&server->lock);
}
