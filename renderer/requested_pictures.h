/* Pictures that clients of the stream request, drawn between the renderer's own by the same thread.
 * A picture is drawn when a client waits for it, at most REQUESTED_PICTURES_FPS times a second; the
 * one that has been due longest comes first. Their quality is lowered, independently of the
 * renderer's own pictures, when all of them together take too long. */
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

#define REQUESTED_PICTURES_FPS      30.0 /* of one picture, at most */
#define REQUESTED_PICTURES_HOLD_FPS 20.0 /* below this rate their quality is lowered */

struct render_session;

/* What is kept of a picture while clients request it. */
struct requested_pictures_row {
    uint64_t generation; /* of its request; 0: free */
    struct view_picture picture;
    struct annotated_picture annotated; /* of its statistics bar; text is NULL without one */
    struct image image;
    uint64_t begun_ns; /* CLOCK_MONOTONIC when it was last drawn; 0: not yet */
    uint64_t frame;    /* of the last picture */
    double ahead_s;    /* how much later than that frame it was; below 0: none yet */
    bool complete;     /* at full quality */
    double rate;       /* pictures a second, measured; 0: not yet known */
};

struct requested_pictures {
    struct requested_pictures_row row[PICTURE_REQUESTS_MAX];
    struct stream_request requests[PICTURE_REQUESTS_MAX]; /* as they were read last */
    uint32_t waiting;                                     /* how many of them a client waits for */
    struct quality_control quality;
};

void requested_pictures_open(struct render_session *session);
void requested_pictures_close(struct render_session *session);

/* Reads the requests. Returns when the next one is due (CLOCK_MONOTONIC), UINT64_MAX for none. */
uint64_t requested_pictures_due_ns(struct render_session *session);

/* Draws the request that has been due longest, if any, with the latest frame, and answers it.
 * Returns 0, or -1 with the reason: the back end has failed. */
int requested_pictures_draw(struct render_session *session, struct error_text *error);

#endif
