/* Passes on pictures of the renderer. Each different picture has a channel with at most one request
 * to the renderer at a time, so that many viewers of the same picture make no more work than one.
 * The proxy's own threads send the requests, each of which takes at most PICTURE_PROXY_FETCH_NS.
 * The absence of the renderer, and its return, are noticed at once.
 *
 * Any thread may call the functions. The proxy's lock is taken inside the console's lock, never
 * around it. */
#ifndef JOLON_CLIENTS_CONSOLE_PICTURE_PROXY_H
#define JOLON_CLIENTS_CONSOLE_PICTURE_PROXY_H

#include "clients/console/http_answer.h"

#include "ipc/segment/segment.h"

#include <pthread.h>
#include <stdatomic.h>

#define PICTURE_PROXY_CHANNELS 24u
#define PICTURE_PROXY_THREADS  8u /* connections to the renderer at most */
#define PICTURE_PROXY_TARGET   192u
#define PICTURE_PROXY_FETCH_NS 2000000000u
#define PICTURE_PROXY_MAX      (8u << 20) /* [byte] of one */

/* An answer of the renderer, which each holder releases. */
struct picture_copy {
    _Atomic uint32_t holders;
    unsigned status; /* 0: the renderer is away, or did not answer in time */
    char *bytes;
    size_t count, room;
    const char *body; /* [body_bytes] within bytes: the picture, or a text */
    size_t body_bytes;
    char type[32], frame[24], time[24]; /* X-Frame and X-Time, "" */
    uint64_t number;                    /* X-Picture, 0: none */
};

/* A request that waits for a picture. */
struct picture_waiter {
    struct picture_waiter *next;
    uint64_t after; /* number of the picture that the page has */
    bool has_after;
    uint32_t fetches; /* that have ended since the request came */
    struct picture_copy *copy;
    bool done;
    void (*ready)(
        struct picture_waiter *waiter); /* called once, without a lock, when copy is set */
};

struct picture_proxy {
    const char *world;
    pthread_mutex_t lock;
    pthread_cond_t work;
    bool ending;
    struct channel {
        char target[PICTURE_PROXY_TARGET]; /* "": not in use */
        bool fetching, lasting;            /* lasting: a map, which hardly changes */
        uint64_t asked_ns, copied_ns;
        struct picture_copy *copy; /* the newest */
        struct picture_waiter *waiting;
    } channel[PICTURE_PROXY_CHANNELS];
    uint32_t turn; /* the channel to be served next */
    pthread_t thread[PICTURE_PROXY_THREADS];
    uint32_t threads;
};

/* Starts the threads. 0, or -1 with the reason. */
int picture_proxy_open(struct picture_proxy *proxy, const char *world, struct error_text *error);
/* Answers the waiting requests and ends the threads. */
void picture_proxy_close(struct picture_proxy *proxy);

/* Writes the address for the renderer, "/picture.jpg?..." or "/map.jpg?...", into target and the
 * number of the picture that the page has into waiter. Returns false, with the answer, if an
 * argument is malformed. */
bool picture_proxy_target(const struct query *query, bool map, char target[PICTURE_PROXY_TARGET],
                          struct picture_waiter *waiter, struct http_answer *answer);

/* Returns true if waiter has its copy or the answer says why there is none; false if ready() will
 * be called later. */
bool picture_proxy_ask(struct picture_proxy *proxy, const char *target,
                       struct picture_waiter *waiter, struct http_answer *answer);

/* copy may be NULL. */
void picture_proxy_release(struct picture_copy *copy);

/* Writes the error of a copy that is no picture. */
void picture_proxy_explain(const struct picture_copy *copy, struct http_answer *answer);

#endif
