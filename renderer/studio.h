/* The studio: everything one renderer keeps from picture to picture, and the steps of making one.
 */
#ifndef JOLON_RENDERER_STUDIO_H
#define JOLON_RENDERER_STUDIO_H

#include "ipc/snapshot.h"
#include "renderer/chart/chart.h"
#include "renderer/draw.h"
#include "renderer/scene/effects.h"
#include "renderer/scene/follow.h"
#include "renderer/options.h"
#include "renderer/output/output.h"
#include "renderer/pulse.h"

#include <stdbool.h>
#include <stdint.h>

struct studio {
    struct view *view;
    struct pulse *pulse;
    struct output *output;  /* NULL: a picture goes where options.snap says */
    struct options options; /* with the world's own where none were given */
    struct snapshot snapshot;
    struct crater_index craters;
    struct dents dents;
    struct event_cursor events;
    struct effects effects;
    struct tracks tracks;
    struct follow follow;
    uint32_t followed; /* slot in the snapshot, SLOT_NONE for none */
    struct scenery scenery;
    struct scene scene;
    struct chart chart;
    struct draw draw; /* self is NULL when only maps are wanted */
    struct image image;
    uint64_t seen;     /* frame of the snapshot */
    uint64_t drawn;    /* frame of the last pictures, UINT64_MAX for none */
    uint64_t drawn_ns; /* CLOCK_MONOTONIC when they were begun */
    uint64_t complained_ns;
};

/* output: NULL to draw into options->snap. 0, or -1 with the reason: no memory, no OpenGL, no font.
 */
int studio_open(struct studio *studio, struct view *view, struct pulse *pulse,
                struct output *output, const struct options *options, struct reason *reason);
void studio_close(struct studio *studio);

/* When the next picture is due (CLOCK_MONOTONIC); UINT64_MAX when only one at the end is. */
uint64_t studio_due_ns(const struct studio *studio);

/* Looks at the world: takes a snapshot and the events since the last. 0; -1 with the reason when
 * the world is damaged or memory is out. A world that goes on too fast to be copied leaves what
 * was seen before, and says so at most every 10 s. */
int studio_look(struct studio *studio, struct reason *reason);

/* Draws what was seen last and writes it out, unless it was drawn before. 0, or -1 with the reason.
 */
int studio_draw(struct studio *studio, struct reason *reason);

#endif
