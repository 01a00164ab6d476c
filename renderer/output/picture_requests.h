/* The table of pictures that clients of the stream ask for: which view, of whom, how large. Pure;
 * the caller has the lock that guards it (renderer/output/stream_internal.h).
 *
 * Two sides use it. The clients' threads make rows and note when somebody asked; the drawing thread
 * reads them, and notes that a vehicle is gone. A row stays while somebody has asked for it lately:
 * with it stay the number of its pictures and what its camera remembers. One that was asked for
 * just once gives way to another: who looks once keeps nobody from watching. */
#ifndef JOLON_RENDERER_OUTPUT_PICTURE_REQUESTS_H
#define JOLON_RENDERER_OUTPUT_PICTURE_REQUESTS_H

#include "world/param_values.h"

#include <stdbool.h>
#include <stdint.h>

#define PICTURE_REQUESTS_MAX     8u
#define PICTURE_REQUESTS_NONE    UINT32_MAX
#define PICTURE_REQUESTS_KEEP_NS 2000000000ull /* a row that nobody asks for stays so long */

struct picture_requests_key {
    enum view_mode view; /* not VIEW_MAP, not VIEW_FREE */
    uint32_t vehicle;    /* id; 0: whom the renderer follows */
    uint32_t width, height;
    bool bar; /* statistics bar and small map */
};

struct picture_requests {
    /* By the clients' threads. */
    struct picture_requests_key key;
    uint64_t generation;   /* no two rows ever have the same; 0: free */
    uint64_t requested_ns; /* CLOCK_MONOTONIC when somebody last asked */
    uint32_t unanswered;   /* requests that are not answered yet */
    bool watched;          /* asked for more than once */
    /* By the drawing thread, but for the beginning. */
    bool gone; /* there is no such vehicle */
};

struct picture_requests_table {
    struct picture_requests row[PICTURE_REQUESTS_MAX];
    uint64_t generations;
};

/* Is anybody waiting for it, or was lately? */
bool picture_requests_lives(const struct picture_requests *row, uint64_t now_ns);

/* The row of this key, asked for now; a new one if there is none, in the place of one that nobody
 * has asked for lately, or else of the one that has been answered for longest of those that are not
 * watched. PICTURE_REQUESTS_NONE when there is neither. */
uint32_t picture_requests_ask(struct picture_requests_table *table,
                              const struct picture_requests_key *key, uint64_t now_ns);

/* Gives a row up now, unless somebody waits. */
void picture_requests_forget(struct picture_requests *row);

#endif
