/* What the parts of the stream share: stream.c has the views and the encoding thread,
 * stream_listen.c the listening sockets, stream_http.c the clients, stream_requests.c requested
 * pictures and maps. One lock guards all of it. No thread draws, encodes or sends under the lock.
 */
#ifndef JOLON_RENDERER_OUTPUT_STREAM_INTERNAL_H
#define JOLON_RENDERER_OUTPUT_STREAM_INTERNAL_H

#include "ipc/http/server.h"
#include "renderer/output/query.h"
#include "renderer/output/stream.h"
#include "renderer/output/picture_requests.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define STREAM_VIEWS_MAX 16u
#define STREAM_WATCHERS  16u /* clients that watch a view at the same time */
#define STREAM_ENDPOINTS 2u
#define STREAM_MAPS      16u /* maps that are kept or being painted */

/* An encoded picture, immutable and shared by counted references. */
struct stream_jpeg {
    _Atomic uint32_t references;
    uint8_t *bytes;
    size_t count;
    uint32_t width, height;
    uint64_t frame;
    double time_s;
};

struct stream_view {
    char name[PICTURE_VIEW_BYTES];
    struct picture *unencoded;        /* the newest picture, until its JPEG is made; else NULL */
    struct stream_jpeg *jpeg;         /* the newest; NULL before the first */
    uint64_t number;                  /* of the JPEG, increasing */
    uint64_t shown_ns;                /* CLOCK_MONOTONIC when it was made or sent again */
    uint32_t watchers, waiters;       /* clients of the stream; clients that wait for one picture */
    uint64_t drawn, encoded, skipped; /* pictures put; JPEGs made; pictures that clients missed */
};

/* A listening socket and its server. */
struct stream_endpoint {
    struct http_listener listener;
    struct http_server *server;
};

/* A requested map. Ground never changes, so a map is kept until another takes its place. */
struct stream_map {
    struct query_map key;
    bool used;
    bool to_paint;         /* the painting thread clears it */
    uint64_t requested_ns; /* CLOCK_MONOTONIC of the last request */
    uint32_t unanswered;   /* requests without an answer yet */
    struct stream_view view;
};

/* The state of one HTTP request, in the server's memory for it (ipc/http/server.h). */
struct stream_client {
    struct stream *stream; /* NULL before the request was read */
    struct stream_view *view;
    struct picture_requests *row; /* of the request, while it has no answer; NULL: none */
    struct stream_map *map;       /* of the request, while it has no answer; NULL: none */
    uint64_t until_ns;            /* end of the wait; 0: no limit */
    struct http_request *request;
    struct stream_client *next; /* in the list of waiting clients */
    bool waits_once;            /* for one picture: counted in the view's waiters */
    struct stream_jpeg *jpeg;   /* being sent */
    char head[192];             /* part header before the JPEG */
    size_t head_bytes, sent;
    uint64_t number; /* of the last picture sent */
};

struct stream {
    char world[32], url[96];
    struct stream_endpoint endpoint[STREAM_ENDPOINTS];
    uint32_t endpoints;
    struct stream_painter painter; /* paint is NULL: there are no maps */
    bool started;
    pthread_t encoding, painting;
    pthread_mutex_t lock;       /* of all below */
    pthread_cond_t encode_cond; /* the encoding thread has something to do, ... */
    pthread_cond_t draw_cond;   /* ... the drawing thread, ... */
    pthread_cond_t paint_cond;  /* ... the painting thread */
    bool ending;
    uint64_t numbers; /* the last number given to a requested picture */
    uint64_t request_count,
        request_count_seen; /* requests that wait for a picture; ... by the drawing thread */
    struct picture_requests_table requests;
    struct stream_view request_view[PICTURE_REQUESTS_MAX]; /* of those rows */
    /* A client waits for a picture, even for an unchanged one. */
    bool again[PICTURE_REQUESTS_MAX];
    struct stream_map map[STREAM_MAPS];
    struct stream_view view[STREAM_VIEWS_MAX];
    uint32_t views;
    struct stream_client *watcher[STREAM_WATCHERS]; /* NULL: free */
    struct stream_client *waiting;
};

/* Starts the servers of all listening sockets. Returns 0, or -1 with the reason. */
int stream_http_start(struct stream *stream, struct error_text *error);

/* Ends the servers. `ending` must be set, so that no client waits again. */
void stream_http_end(struct stream *stream);

/* Replies with a line of plain text. */
void stream_refuse(struct http_reply *reply, unsigned status, const char *text);
/* Replies with a picture, which the reply holds until it is sent. */
void stream_reply_jpeg(struct http_reply *reply, struct stream_jpeg *jpeg);

/* --- under the lock ----------------------------------------------------------------------------
 */

/* Gives up connections that are out of time. */
void stream_http_sweep(struct stream *stream);

/* Wakes the clients that wait for this view; NULL: for any view. */
void stream_http_wake(struct stream *stream, const struct stream_view *view);

/* Wakes the clients whose time is over. Returns when the next client's time is over [ns], or
 * UINT64_MAX if no client waits. */
uint64_t stream_http_expire(struct stream *stream, uint64_t now_ns);

/* Keeps a request waiting for its view's next picture. Returns false, as there is no reply yet. */
bool stream_wait_here(struct stream_client *client);

struct stream_view *stream_find_view(struct stream *stream, const char *name, size_t length);
/* Add and remove a holder of a JPEG, with or without the lock. jpeg is a struct stream_jpeg;
 * stream_release() ignores NULL. */
struct stream_jpeg *stream_hold(struct stream_jpeg *jpeg);
void stream_release(void *jpeg);
/* Returns the picture as a JPEG, or NULL when there is no memory. Called without the lock. */
struct stream_jpeg *stream_encode(const struct image *image, uint64_t frame, double time_s);

/* Answer "/picture.jpg?..." and "/map.jpg?...". Return false if the request must wait. */
bool stream_requests_picture(struct stream_client *client, struct http_reply *reply);
bool stream_requests_map(struct stream_client *client, struct http_reply *reply);
/* Releases what a request still holds at its end. */
void stream_requests_end(struct stream_client *client);

/* The thread that paints maps; argument: the stream. */
void *stream_paint(void *argument);

#endif
