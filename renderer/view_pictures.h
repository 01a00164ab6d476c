/* The pictures of a frame: one of each view, with its camera. */
#ifndef JOLON_RENDERER_VIEW_PICTURES_H
#define JOLON_RENDERER_VIEW_PICTURES_H

#include "renderer/scene/camera/view_camera.h"
#include "renderer/chart/annotated_picture.h"
#include "renderer/quality_control.h"
#include "renderer/scene/frame/frame_view.h"
#include "renderer/views.h"

#include <stdbool.h>
#include <stdint.h>

struct render_session;

struct view_picture {
    struct view_spec spec;
    struct view_camera_options camera_options;
    struct view_camera view_camera;
    uint32_t slot; /* of its vehicle in the frame that is drawn; SLOT_NONE for none */
};

/* Draws every view of the latest frame and outputs the pictures, unless it was drawn before. last:
 * draws exactly the latest frame, at full quality. Returns 0, or -1 with the reason. */
int view_pictures_draw(struct render_session *session, bool last, struct error_text *error);

/* The image of a camera's picture, and what is drawn over it. */
struct view_picture_target {
    struct image *image;
    struct annotated_picture *annotated; /* of the image's size, for the instruments; NULL: none */
    double rate;                         /* pictures a second, which the instruments show */
};

/* Returns the frame to draw: the latest frame or, at a high rate, an interpolation between it and
 * the one before. last: the latest frame in any case. Valid until the next call. */
struct frame_view view_pictures_frame(struct render_session *session, bool last);

/* Returns the slot of a vehicle, SLOT_NONE when there is none; 0: of the followed vehicle. */
uint32_t view_pictures_vehicle(struct render_session *session, const struct frame_view *frame_view,
                               uint32_t vehicle);

/* Draws what a picture's camera sees. Returns 0, or -1 with the reason. */
int view_pictures_camera(struct render_session *session, struct view_picture *picture,
                         const struct frame_view *frame_view,
                         const struct quality_control_level *level,
                         const struct view_picture_target *target, struct error_text *error);

/* Returns a rate [pictures a second] with another interval averaged in. rate 0: not yet known. */
double view_pictures_rate(double rate, uint64_t interval_ns);

/* Adjusts quality after a picture that was begun at begun_ns (CLOCK_MONOTONIC), as if it had taken
 * count times as long, and logs a change. which and object complete the text. */
void view_pictures_adjust_quality(struct quality_control *quality, uint64_t begun_ns,
                                  uint32_t count, const char *which, const char *object);

#endif
