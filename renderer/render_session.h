/* A render session: everything that one renderer keeps from picture to picture. */
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

/* From this rate on, pictures interpolate between frames. */
#define RENDER_SESSION_SMOOTH_FPS     20.0
#define RENDER_SESSION_TEXTURE_BUDGET 4u /* textures that such a picture may make, 1 ms each */

struct render_session {
    struct view *view;
    struct heartbeat *heartbeat;
    struct output_set *outputs;  /* NULL: one picture is drawn, into the file options.snap */
    struct options options;      /* with the scenario's values where none were given */
    struct snapshot snapshot[2]; /* the last two frames copied */
    uint32_t latest;             /* index of the later one */
    uint32_t snapshots_taken;    /* valid snapshots: 0, 1, 2 */
    bool smooth;                 /* pictures interpolate between the snapshots */
    double at_s;                 /* time of simulation to draw; below 0: it follows the clock */
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
    struct back_end_interface draw; /* self is NULL when only maps are drawn */
    struct image image;
    struct image small; /* for pictures that are scaled up; memory for a full one */
    struct quality_control quality;
    uint64_t seen;        /* frame of the latest snapshot */
    uint64_t drawn;       /* frame of the last pictures, UINT64_MAX: none */
    double drawn_ahead_s; /* how much later than that frame they were */
    bool drawn_complete;  /* at full quality */
    uint64_t drawn_ns;    /* CLOCK_MONOTONIC when they were begun */
    double rate;          /* pictures a second, measured; 0: not yet known */
    struct requested_pictures requested;
    uint64_t warned_ns;
};

/* outputs: NULL to draw into options->snap. Returns 0, or -1 with the reason: no memory, no back
 * end, no font. */
int render_session_open(struct render_session *session, struct view *view,
                        struct heartbeat *heartbeat, struct output_set *outputs,
                        const struct options *options, struct error_text *error);
void render_session_close(struct render_session *session);

/* Returns when the next pictures are due (CLOCK_MONOTONIC); UINT64_MAX at a rate of 0. */
uint64_t render_session_due_ns(const struct render_session *session);

/* Takes a snapshot of the latest frame, and the events since the last one. When frames follow each
 * other too fast to be copied, it keeps the earlier snapshot and warns at most every 10 s. Returns
 * 0, or -1 with the reason when the world is damaged. */
int render_session_update(struct render_session *session, struct error_text *error);

/* Checks that the latest snapshot has every vehicle that the options name by id. Returns 0, or -1
 * with the reason. */
int render_session_check_vehicles(const struct render_session *session, struct error_text *error);

/* Returns a view of one of the snapshots, valid until that is taken again. */
struct frame_view render_session_frame_view(const struct render_session *session, uint32_t which);

#endif
