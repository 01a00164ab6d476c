/* The HTTP server of the console and of the renderer's stream, by libmicrohttpd: one listening
 * socket, one thread. It checks by which name it is asked, bounds its connections and their time
 * (ipc/http/connection_limit.h), sends answers, and hands requests to a handler. It makes no system
 * call but those of the sandbox's list "serving". */
#ifndef JOLON_IPC_HTTP_SERVER_H
#define JOLON_IPC_HTTP_SERVER_H

#include "ipc/http/listen.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#define HTTP_HEADERS_MAX 4u /* of a reply's own */

struct http_server;

/* A request whose body is there, until its answer has been sent or given up. */
struct http_request {
    const char *method, *path;
    const char *body;  /* its first handler.body_max bytes */
    size_t body_bytes; /* more than handler.body_max: it was longer, and is not whole */
    bool woken;        /* it has waited, and the handler is asked again */
    void *own;         /* the handler's, zeroed at the beginning */
};

/* What a request is answered. The server sends `bytes`, or what `give` gives. */
struct http_reply {
    unsigned status;
    const char *type;  /* Content-Type */
    const char *cache; /* Cache-Control; NULL: no-store */
    const void *bytes;
    size_t count;
    void (*release)(void *owner); /* once, when bytes are needed no longer; NULL: nothing */
    void *owner;
    /* Copies what comes next, without any lock of the server; how much, 0 after http_wait(), -1
     * for the end. */
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

/* All are called in the server's thread. */
struct http_handler {
    void *context;
    size_t own_bytes, body_max;
    const struct http_header *headers; /* of every answer; the last one's name is NULL */
    /* Fills the reply, or calls http_wait() and returns false: then it is called again. */
    bool (*answer)(void *context, struct http_request *request, struct http_reply *reply);
    /* Fills the reply to a request that the server itself refuses: what is wrong, what to do. */
    void (*refuse)(struct http_reply *reply, unsigned status, const char *what, const char *next);
    /* Once, whatever became of the request. */
    void (*end)(void *context, struct http_request *request);
};

/* Starts to serve on the listener, which becomes the server's: its fd is then -1. Two servers of a
 * process share its descriptors: the soft limit (RLIMIT_NOFILE) is raised to 1024 where that is
 * allowed, and with less there are fewer connections. NULL with the reason. */
struct http_server *http_server_start(struct http_listener *listener,
                                      const struct http_handler *handler, struct error_text *error);

/* Ends all connections and the thread; none may be waiting. NULL is nothing. */
void http_server_stop(struct http_server *server);

/* Gives up connections that are out of time. To be called about once a second. */
void http_server_sweep(struct http_server *server, uint64_t now_ns);

/* --- of a request, in the handler ---------------------------------------------------------------
 */

/* The value of a header, or of a key of the address (?KEY=VALUE); NULL when there is none. */
const char *http_header(struct http_request *request, const char *name);
const char *http_argument(struct http_request *request, const char *key);

/* How many keys the address has; take, unless NULL, gets each until it returns false. A key without
 * a value has NULL. */
int http_arguments(struct http_request *request,
                   bool (*take)(void *context, const char *key, const char *value), void *context);

/* Is it within the requests a second of its connection, and, unless apart or on loopback, of its
 * address? */
bool http_may_ask(struct http_request *request, bool apart, uint64_t now_ns);

/* A reply of text, which is copied. Without memory there is no answer. */
void http_reply_text(struct http_reply *reply, unsigned status, const char *type, const char *text);
void http_reply_add(struct http_reply *reply, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Keeps the request waiting from its callback's end on, and lets it go on, from any thread. Both
 * under one lock of the handler's, so that the second comes after the first. */
void http_wait(struct http_request *request);
void http_wake(struct http_request *request);

/* Shuts the request's connection if its client has taken no part of an answer for a second,
 * though there was one. Any thread. */
bool http_drop_stalled(struct http_request *request, uint64_t now_ns);

#endif
