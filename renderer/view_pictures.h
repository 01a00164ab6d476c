/* One view of what is to be drawn, and its camera. */
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
    uint32_t slot; /* of its vehicle in the moment that is drawn; SLOT_NONE for none */
};

/* Draws what was seen last and writes it out, every view, unless it was drawn before. last: exactly
 * the last frame seen, at full quality, whatever the rate. 0, or -1 with the reason. */
int view_pictures_draw(struct render_session *session, bool last, struct error_text *error);

/* Where a camera's picture goes, and what is laid over it. */
struct view_picture_target {
    struct image *image;
    struct annotated_picture *annotated; /* instruments of the image's size; NULL: none */
    double rate;                         /* pictures a second, for them */
};

/* What is shown: the last frame, or at a high rate the state between it and the one before. It
 * lives until the next call. */
struct frame_view view_pictures_frame(struct render_session *session, bool last);

/* The slot of a vehicle, SLOT_NONE when there is none; of 0: of the one that is followed. */
uint32_t view_pictures_vehicle(struct render_session *session, const struct frame_view *frame_view,
                               uint32_t vehicle);

/* Draws what a shot's camera sees. 0, or -1 with the reason. */
int view_pictures_camera(struct render_session *session, struct view_picture *picture,
                         const struct frame_view *frame_view,
                         const struct quality_control_level *level,
                         const struct view_picture_target *target, struct error_text *error);

#endif
