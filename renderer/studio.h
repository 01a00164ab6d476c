/* The studio: everything one renderer keeps from picture to picture, and the steps of making them.
 */
#ifndef JOLON_RENDERER_STUDIO_H
#define JOLON_RENDERER_STUDIO_H

#include "ipc/snapshot.h"
#include "renderer/booth.h"
#include "renderer/chart/chart.h"
#include "renderer/draw.h"
#include "renderer/governor.h"
#include "renderer/options.h"
#include "renderer/output/outlets.h"
#include "renderer/pulse.h"
#include "renderer/scene/blend.h"
#include "renderer/scene/effects.h"
#include "renderer/scene/follow.h"
#include "renderer/shot.h"
#include "renderer/views.h"

#include <stdbool.h>
#include <stdint.h>

#define STUDIO_SMOOTH_FPS 20.0 /* from this rate on, pictures show what is between frames */
#define STUDIO_PAINTINGS  4u   /* tiles of ground that one of these paints, 1 ms each */

struct studio {
    struct view *view;
    struct pulse *pulse;
    struct outlets *outlets;     /* NULL: a picture goes where options.snap says */
    struct options options;      /* with the world's own where none were given */
    struct snapshot snapshot[2]; /* the last two frames seen ... */
    uint32_t latest;             /* ... and which of them is the later */
    uint32_t whole;              /* of them there are: 0, 1, 2 */
    bool smooth;                 /* draws between them, ... */
    double at_s;                 /* ... at this time of simulation; below 0: by the clock */
    struct blend blend;
    struct blend_clock clock;
    struct crater_index craters;
    struct dents dents;
    struct event_cursor events;
    struct effects effects;
    struct tracks tracks;
    struct gear gear;
    struct follow follow;
    struct shot shots[VIEWS_MAX];
    uint32_t shot_count;
    struct scenery scenery;
    struct scene scene;
    struct chart chart;
    struct draw draw; /* self is NULL when only maps are wanted */
    struct image image;
    struct image small; /* what is drawn smaller and then stretched; the memory of a whole one */
    struct governor governor;
    uint64_t seen;        /* frame of the latest snapshot */
    uint64_t drawn;       /* frame of the last pictures, UINT64_MAX for none, ... */
    double drawn_ahead_s; /* ... and how much later they were */
    bool drawn_whole;     /* ... and with everything */
    uint64_t drawn_ns;    /* CLOCK_MONOTONIC when they were begun */
    double rate;          /* pictures a second, measured; 0: not yet */
    struct booth booth;
    uint64_t complained_ns;
};

/* outlets: NULL to draw into options->snap. 0, or -1 with the reason: no memory, nothing to draw
 * with, no font. */
int studio_open(struct studio *studio, struct view *view, struct pulse *pulse,
                struct outlets *outlets, const struct options *options, struct reason *reason);
void studio_close(struct studio *studio);

/* When the next pictures are due (CLOCK_MONOTONIC); UINT64_MAX when only those at the end are. */
uint64_t studio_due_ns(const struct studio *studio);

/* Looks at the world: takes a snapshot and the events since the last. 0; -1 with the reason when
 * the world is damaged or memory is out. A world that goes on too fast to be copied leaves what
 * was seen before, and says so at most every 10 s. */
int studio_look(struct studio *studio, struct reason *reason);

/* Is every vehicle that was asked for by number in the frame seen last? 0, or -1 with the reason.
 */
int studio_check_vehicles(const struct studio *studio, struct reason *reason);

/* The frame of one of the snapshots; it lives as long as that holds it. */
struct moment studio_moment(const struct studio *studio, uint32_t which);

/* Draws what was seen last and writes it out, every view, unless it was drawn before. last: exactly
 * the last frame seen, at full quality, whatever the rate. 0, or -1 with the reason. */
int studio_draw(struct studio *studio, bool last, struct reason *reason);

/* --- for the booth ------------------------------------------------------------------------------
 */

/* Where a camera's picture goes, and what is laid over it. */
struct studio_sheet {
    struct image *image;
    struct chart *chart; /* instruments of the image's size; NULL: none */
    double rate;         /* pictures a second, for them */
};

/* What is shown: the last frame, or at a high rate the state between it and the one before. It
 * lives until the next call. */
struct moment studio_present(struct studio *studio, bool last);

/* The slot of a vehicle, SLOT_NONE when there is none; of 0: of the one that is followed. */
uint32_t studio_find(struct studio *studio, const struct moment *moment, uint32_t vehicle);

/* Draws what a shot's camera sees. 0, or -1 with the reason. */
int studio_shoot(struct studio *studio, struct shot *shot, const struct moment *moment,
                 const struct governor_level *level, const struct studio_sheet *sheet,
                 struct reason *reason);

#endif
