/* Pictures of the renderer, passed on. Each different picture has a channel, on which one request
 * to the renderer is under way at a time, whoever waits: many who look at the same make no more
 * work than one. Threads of their own fetch, each for at most PICTURE_PROXY_FETCH_NS. A renderer
 * that is away is found out at once, and so is its return.
 *
 * Any thread; its lock is taken within the console's, never around it. */
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

/* What the renderer answered; who holds it lets it go. */
struct picture_copy {
    _Atomic uint32_t holders;
    unsigned status; /* 0: it is away, or did not answer in time */
    char *bytes;
    size_t count, room;
    const char *body; /* [body_bytes] within bytes: the picture, or words */
    size_t body_bytes;
    char type[32], frame[24], time[24]; /* X-Frame and X-Time, "" */
    uint64_t number;                    /* X-Picture, 0: none */
};

/* Somebody who waits for a picture. */
struct gaze {
    struct gaze *next;
    uint64_t after; /* of the picture that it has */
    bool has_after;
    uint32_t fetches; /* that came meanwhile */
    struct picture_copy *copy;
    bool done;
    void (*ready)(struct gaze *gaze); /* once, without any lock, when copy is there */
};

struct picture_proxy {
    const char *world;
    pthread_mutex_t lock;
    pthread_cond_t come;
    bool ending;
    struct channel {
        char target[PICTURE_PROXY_TARGET]; /* "": not in use */
        bool fetching, lasting;            /* lasting: it does not change, as maps */
        uint64_t asked_ns, copied_ns;
        struct picture_copy *copy; /* the newest */
        struct gaze *waiting;
    } channel[PICTURE_PROXY_CHANNELS];
    uint32_t turn; /* the channel to be looked at next */
    pthread_t thread[PICTURE_PROXY_THREADS];
    uint32_t threads;
};

/* Starts the threads. 0, or -1 with the reason. */
int picture_proxy_open(struct picture_proxy *pictures, const char *world, struct reason *reason);
/* Answers who waits; the threads end. */
void picture_proxy_close(struct picture_proxy *pictures);

/* What a request asks the renderer for: writes "/picture.jpg?..." or "/map.jpg?..." into target and
 * the picture that it has into gaze. False with the answer when it makes no sense. */
bool picture_proxy_target(const struct query *query, bool map, char target[PICTURE_PROXY_TARGET],
                          struct gaze *gaze, struct http_answer *answer);

/* True: gaze has its copy, or the answer says why there is none; false: ready will be called. */
bool picture_proxy_ask(struct picture_proxy *pictures, const char *target, struct gaze *gaze,
                       struct http_answer *answer);

/* NULL is nothing. */
void picture_proxy_release(struct picture_copy *copy);

/* Words for a copy that is no picture. */
void picture_proxy_explain(const struct picture_copy *copy, struct http_answer *answer);

#endif
