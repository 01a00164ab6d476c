/* The booth: pictures that clients of the stream ask for, drawn between the renderer's own by the
 * same thread. Each is drawn when somebody waits for it, REQUESTED_PICTURES_FPS times a second at
 * most; whichever is due longest comes first, and a governor of their own lowers what they show
 * when all of them together take too long. While nobody asks, nothing is done. */
#ifndef JOLON_RENDERER_REQUESTED_PICTURES_H
#define JOLON_RENDERER_REQUESTED_PICTURES_H

#include "ipc/segment/segment.h"
#include "renderer/chart/annotated_picture.h"
#include "renderer/quality_control.h"
#include "renderer/output/stream.h"
#include "renderer/view_pictures.h"
#include "renderer/output/stream_requests.h"

#include <stdbool.h>
#include <stdint.h>

#define REQUESTED_PICTURES_FPS      30.0 /* of one picture, at most ... */
#define REQUESTED_PICTURES_HOLD_FPS 20.0 /* ... and below this they show less */

struct render_session;

/* What is kept of a picture while somebody asks for it. */
struct requested_pictures_row {
    uint64_t generation; /* of the wish that it is for; 0: none */
    struct view_picture picture;
    struct annotated_picture annotated; /* of the bar; text is NULL when there is none */
    struct image image;
    uint64_t begun_ns; /* CLOCK_MONOTONIC when it was last drawn; 0: not yet */
    uint64_t frame;    /* that it was drawn of, ... */
    double ahead_s;    /* ... and how much later than that; below 0: not yet */
    bool complete;     /* ... and with everything */
    double rate;       /* pictures a second, measured; 0: not yet */
};

struct requested_pictures {
    struct requested_pictures_row row[PICTURE_REQUESTS_MAX];
    struct stream_request requests[PICTURE_REQUESTS_MAX]; /* as they were looked at last */
    uint32_t waiting;                                     /* of them */
    struct quality_control quality;
};

void requested_pictures_open(struct render_session *session);
void requested_pictures_close(struct render_session *session);

/* Looks at what is asked for. When the next of it is due (CLOCK_MONOTONIC), UINT64_MAX for none. */
uint64_t requested_pictures_due_ns(struct render_session *session);

/* Draws the one that has been due longest, of the frame seen last, and gives it to who waits.
 * Nothing when none is due. 0, or -1 with the reason: the back end is of no more use. */
int requested_pictures_draw(struct render_session *session, struct error_text *error);

#endif
