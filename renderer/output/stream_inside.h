/* What the two halves of the stream share: stream.c, which has the views, and stream_http.c, which
 * has the clients. */
#ifndef JOLON_RENDERER_STREAM_INSIDE_H
#define JOLON_RENDERER_STREAM_INSIDE_H

#include "renderer/output/stream.h"

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define STREAM_VIEWS_MAX 16u
#define STREAM_WATCHERS  16u /* clients that watch at the same time */
#define STREAM_CLIENTS   32u /* connections in all: so that who is too much is told */

struct MHD_Connection;
struct MHD_Daemon;

/* An encoded picture; under the stream's lock but for the bytes, which nobody changes. */
struct stream_jpeg {
    uint8_t *bytes;
    size_t count;
    uint32_t holders, width, height;
    uint64_t frame;
    double time_s;
};

struct stream_view {
    char name[PICTURE_VIEW_BYTES];
    struct picture *fresh;     /* the newest, when there is no JPEG of it yet; else NULL */
    struct stream_jpeg *jpeg;  /* the newest there is; NULL before the first */
    uint64_t number;           /* of what is shown: goes up with every JPEG */
    uint64_t shown_ns;         /* CLOCK_MONOTONIC of that */
    uint32_t watchers, askers; /* clients of the stream; those who wait for one picture now */
    uint64_t drawn, encoded, skipped; /* pictures put; JPEGs made; those that clients passed over */
};

/* A client that waits for a picture: its connection is suspended until there is one. */
struct stream_client {
    struct stream *stream;
    struct stream_view *view;
    struct MHD_Connection *connection;
    struct stream_client *next; /* of those that wait */
    bool suspended;             /* in the list */
    bool watching, asked;       /* counted in the view's watchers, askers */
    struct stream_jpeg *jpeg;   /* being sent */
    char head[192];             /* before it */
    size_t head_bytes, sent;
    uint64_t number; /* of the last that was sent */
};

struct stream {
    char world[32], url[96];
    int listener;
    bool local; /* only this machine can reach it */
    struct MHD_Daemon *daemon;
    pthread_t thread;
    pthread_mutex_t lock; /* of all below */
    pthread_cond_t come;
    bool ending;
    struct stream_view view[STREAM_VIEWS_MAX];
    uint32_t views, watchers;
    struct stream_client *waiting;
};

/* Starts and ends libmicrohttpd on the stream's listener. 0, or -1 with errno. The second wants
 * `ending` set, so that nobody waits again. */
int stream_http_start(struct stream *stream);
void stream_http_end(struct stream *stream);

/* Under the lock: lets go on who waits for this view, NULL: for any. */
void stream_http_wake(struct stream *stream, const struct stream_view *view);

/* Under the lock. */
struct stream_view *stream_find(struct stream *stream, const char *name, size_t length);
struct stream_jpeg *stream_hold(struct stream_jpeg *jpeg);
void stream_release(struct stream_jpeg *jpeg);

#endif
