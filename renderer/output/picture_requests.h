/* The table of requested pictures: view, vehicle and size. Pure; the caller holds the lock that
 * guards it (renderer/output/stream_internal.h).
 *
 * The clients' threads make rows and note the times of requests. The drawing thread reads the rows,
 * and notes that a vehicle does not exist. A row is kept while clients have requested it lately,
 * and with it the number of its pictures and its camera's state. A row that was requested only once
 * is evicted first, so that single requests do not displace clients that watch. */
#ifndef JOLON_RENDERER_OUTPUT_PICTURE_REQUESTS_H
#define JOLON_RENDERER_OUTPUT_PICTURE_REQUESTS_H

#include "world/view_mode.h"

#include <stdbool.h>
#include <stdint.h>

#define PICTURE_REQUESTS_MAX     8u
#define PICTURE_REQUESTS_NONE    UINT32_MAX
#define PICTURE_REQUESTS_KEEP_NS 2000000000ull /* a row is kept so long after its last request */

struct picture_requests_key {
    enum view_mode view; /* not VIEW_MAP, not VIEW_FREE */
    uint32_t vehicle;    /* id; 0: the one that the renderer follows */
    uint32_t width, height;
    bool bar; /* statistics bar and small map */
};

struct picture_requests {
    /* Written by the clients' threads. */
    struct picture_requests_key key;
    uint64_t generation;   /* unique; 0: the row is free */
    uint64_t requested_ns; /* CLOCK_MONOTONIC of the last request */
    uint32_t unanswered;   /* requests without an answer yet */
    bool watched;          /* requested more than once */
    /* Written by the drawing thread, and cleared by the clients' threads. */
    bool gone; /* there is no such vehicle */
};

struct picture_requests_table {
    struct picture_requests row[PICTURE_REQUESTS_MAX];
    uint64_t generations;
};

/* Returns true if a client waits for the row or has requested it lately. */
bool picture_requests_lives(const struct picture_requests *row, uint64_t now_ns);

/* Returns the index of the key's row, and notes the request. A new row takes the place of one that
 * is not alive, or else of the answered row that is not watched and whose request is the oldest.
 * Returns PICTURE_REQUESTS_NONE when there is neither. */
uint32_t picture_requests_ask(struct picture_requests_table *table,
                              const struct picture_requests_key *key, uint64_t now_ns);

/* Frees a row, unless a client waits for it. */
void picture_requests_forget(struct picture_requests *row);

#endif
