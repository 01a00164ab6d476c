/* The booth: pictures that clients of the stream ask for, drawn between the renderer's own by the
 * same thread. Each is drawn when somebody waits for it, BOOTH_FPS times a second at most;
 * whichever is due longest comes first, and a governor of their own lowers what they show when all
 * of them together take too long. While nobody asks, nothing is done. */
#ifndef JOLON_RENDERER_BOOTH_H
#define JOLON_RENDERER_BOOTH_H

#include "ipc/segment.h"
#include "renderer/chart/chart.h"
#include "renderer/governor.h"
#include "renderer/output/stream.h"
#include "renderer/shot.h"

#include <stdbool.h>
#include <stdint.h>

#define BOOTH_FPS      30.0 /* of one picture, at most ... */
#define BOOTH_HOLD_FPS 20.0 /* ... and below this they show less */

struct studio;

/* What is kept of a picture while somebody asks for it. */
struct booth_row {
    uint64_t generation; /* of the wish that it is for; 0: none */
    struct shot shot;
    struct chart chart; /* of the bar; text is NULL when there is none */
    struct image image;
    uint64_t begun_ns; /* CLOCK_MONOTONIC when it was last drawn; 0: not yet */
    uint64_t frame;    /* that it was drawn of, ... */
    double ahead_s;    /* ... and how much later than that; below 0: not yet */
    bool whole;        /* ... and with everything */
    double rate;       /* pictures a second, measured; 0: not yet */
};

struct booth {
    struct booth_row row[WANTED_MAX];
    struct stream_wish wishes[WANTED_MAX]; /* as they were looked at last */
    uint32_t waiting;                      /* of them */
    struct governor governor;
};

void booth_open(struct studio *studio);
void booth_close(struct studio *studio);

/* Looks at what is asked for. When the next of it is due (CLOCK_MONOTONIC), UINT64_MAX for none. */
uint64_t booth_due_ns(struct studio *studio);

/* Draws the one that has been due longest, of the frame seen last, and gives it to who waits.
 * Nothing when none is due. 0, or -1 with the reason: the back end is of no more use. */
int booth_draw(struct studio *studio, struct reason *reason);

#endif
