/* A render session: everything that one renderer keeps from picture to picture.
 */
#ifndef JOLON_RENDERER_RENDER_SESSION_H
#define JOLON_RENDERER_RENDER_SESSION_H

#include "ipc/frame/event_cursor.h"
#include "ipc/frame/snapshot.h"
#include "renderer/requested_pictures.h"
#include "renderer/chart/annotated_picture.h"
#include "renderer/scene/back_end_interface.h"
#include "renderer/quality_control.h"
#include "renderer/options.h"
#include "renderer/output/output_set.h"
#include "renderer/heartbeat.h"
#include "renderer/scene/frame/frame_interpolation.h"
#include "renderer/scene/frame/effects.h"
#include "renderer/scene/camera/follow.h"
#include "renderer/view_pictures.h"
#include "renderer/views.h"

#include <stdbool.h>
#include <stdint.h>

#define RENDER_SESSION_SMOOTH_FPS                                                                  \
    20.0                            /* from this rate on, pictures show what is between frames     \
                                     */
#define RENDER_SESSION_PAINTINGS 4u /* tiles of ground that one of these paints, 1 ms each */

struct render_session {
    struct view *view;
    struct heartbeat *heartbeat;
    struct output_set *outputs;  /* NULL: a picture goes where options.snap says */
    struct options options;      /* with the world's own where none were given */
    struct snapshot snapshot[2]; /* the last two frames seen ... */
    uint32_t latest;             /* ... and which of them is the later */
    uint32_t snapshots_taken;    /* of them there are: 0, 1, 2 */
    bool smooth;                 /* draws between them, ... */
    double at_s;                 /* ... at this time of simulation; below 0: by the clock */
    struct frame_interpolation interpolation;
    struct frame_interpolation_clock clock;
    struct crater_index craters;
    struct dent_index dents;
    struct event_cursor events;
    struct effects effects;
    struct tracks tracks;
    struct articulation articulation;
    struct follow follow;
    struct view_picture pictures[VIEWS_MAX];
    uint32_t picture_count;
    struct static_scene static_scene;
    struct draw_list draw_list;
    struct annotated_picture annotated;
    struct back_end_interface draw; /* self is NULL when only maps are wanted */
    struct image image;
    struct image small; /* what is drawn smaller and then stretched; the memory of a whole one */
    struct quality_control quality;
    uint64_t seen;        /* frame of the latest snapshot */
    uint64_t drawn;       /* frame of the last pictures, UINT64_MAX for none, ... */
    double drawn_ahead_s; /* ... and how much later they were */
    bool drawn_complete;  /* ... and with everything */
    uint64_t drawn_ns;    /* CLOCK_MONOTONIC when they were begun */
    double rate;          /* pictures a second, measured; 0: not yet */
    struct requested_pictures requested;
    uint64_t warned_ns;
};

/* outlets: NULL to draw into options->snap. 0, or -1 with the reason: no memory, nothing to draw
 * with, no font. */
int render_session_open(struct render_session *session, struct view *view,
                        struct heartbeat *heartbeat, struct output_set *outputs,
                        const struct options *options, struct error_text *error);
void render_session_close(struct render_session *session);

/* When the next pictures are due (CLOCK_MONOTONIC); UINT64_MAX when only those at the end are. */
uint64_t render_session_due_ns(const struct render_session *session);

/* Looks at the world: takes a snapshot and the events since the last. 0; -1 with the reason when
 * the world is damaged or memory is out. A world that goes on too fast to be copied leaves what
 * was seen before, and says so at most every 10 s. */
int render_session_update(struct render_session *session, struct error_text *error);

/* Is every vehicle that was asked for by number in the frame seen last? 0, or -1 with the reason.
 */
int render_session_check_vehicles(const struct render_session *session, struct error_text *error);

/* The frame of one of the snapshots; it lives as long as that holds it. */
struct frame_view render_session_frame_view(const struct render_session *session, uint32_t which);

#endif
