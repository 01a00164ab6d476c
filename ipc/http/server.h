/* The HTTP server of the console and of the renderer's stream, by libmicrohttpd: one listening
 * socket and one thread. It checks the Host header, limits connections and their time
 * (ipc/http/connection_limit.h), sends answers, and passes requests to a handler. It makes only the
 * system calls of the sandbox's list "serving". */
#ifndef JOLON_IPC_HTTP_SERVER_H
#define JOLON_IPC_HTTP_SERVER_H

#include "ipc/http/listen.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#define HTTP_HEADERS_MAX 4u /* headers of one reply */

struct http_server;

/* A request with its body, until its answer has been sent or given up. */
struct http_request {
    const char *method, *path;
    const char *body;  /* its first handler.body_max bytes */
    size_t body_bytes; /* if more than handler.body_max, the body is cut */
    bool woken;        /* it has waited, and the handler is called again */
    void *own;         /* own_bytes of the handler's, zero at first */
};

/* The answer to a request. The server sends `bytes`, or what `give` copies. */
struct http_reply {
    unsigned status;
    const char *type;  /* Content-Type */
    const char *cache; /* Cache-Control; NULL: no-store */
    const void *bytes;
    size_t count;
    void (*release)(void *owner); /* called once when bytes are no longer needed, or NULL */
    void *owner;
    /* Copies the next bytes, called without any lock of the server. Returns their number, 0 after
     * http_wait(), -1 at the end. */
    ssize_t (*give)(struct http_request *request, char *to, size_t room);
    struct {
        const char *name;
        char value[32];
    } header[HTTP_HEADERS_MAX];
    uint32_t headers;
};

struct http_header {
    const char *name, *value;
};

/* The handler of requests. All functions are called in the server's thread. */
struct http_handler {
    void *context;
    size_t own_bytes, body_max;
    const struct http_header *headers; /* added to every answer; ends with a NULL name */
    /* Fills the reply and returns true. Or calls http_wait() and returns false; it is called again
     * when the request is woken. */
    bool (*answer)(void *context, struct http_request *request, struct http_reply *reply);
    /* Fills the reply to a request that the server itself refuses: what is wrong, and what to
     * do. */
    void (*refuse)(struct http_reply *reply, unsigned status, const char *what, const char *next);
    /* Called once at the end of each request, also of an abandoned request. */
    void (*end)(void *context, struct http_request *request);
};

/* Starts to serve on the listener, whose fd the server takes over (it is then -1). Two servers of a
 * process share its descriptors: the soft limit (RLIMIT_NOFILE) is raised to 1024 if that is
 * allowed, and with less there are fewer connections. Returns NULL with the reason. */
struct http_server *http_server_start(struct http_listener *listener,
                                      const struct http_handler *handler, struct error_text *error);

/* Ends all connections and the thread. No request may be waiting. NULL is allowed. */
void http_server_stop(struct http_server *server);

/* Shuts connections that have exceeded their time. To be called about once a second. */
void http_server_sweep(struct http_server *server, uint64_t now_ns);

/* --- of a request, in the handler ---------------------------------------------------------------
 */

/* Returns the value of a header, or of a key of the query (?KEY=VALUE), NULL when there is none. */
const char *http_header(struct http_request *request, const char *name);
const char *http_argument(struct http_request *request, const char *key);

/* Returns the number of keys in the query. take, unless NULL, is called for each until it returns
 * false. A key without a value has NULL. */
int http_arguments(struct http_request *request,
                   bool (*take)(void *context, const char *key, const char *value), void *context);

/* Returns true if the request is within the rate of its connection and of its address. Loopback
 * addresses have no rate; no_address_rate excludes others. */
bool http_may_ask(struct http_request *request, bool no_address_rate, uint64_t now_ns);

/* Fills a reply with a copy of text. Without memory the connection is closed. */
void http_reply_text(struct http_reply *reply, unsigned status, const char *type, const char *text);
void http_reply_add(struct http_reply *reply, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Suspends the request from the end of its callback on, and resumes it, from any thread. The
 * handler calls both under one lock of its own, so that the second comes after the first. */
void http_wait(struct http_request *request);
void http_wake(struct http_request *request);

/* Shuts the request's connection if its client has taken no part of a pending answer for a second.
 * Returns true if it did. Any thread. */
bool http_drop_stalled(struct http_request *request, uint64_t now_ns);

#endif
