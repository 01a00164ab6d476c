/* Interpolation between two committed frames. A renderer draws at its own rate. It shows every body
 * at the time of the picture, one frame behind the world. Pure.
 *
 * The interpolated state is that of the earlier frame. Only the positions and angles of bodies that
 * are in both frames are interpolated. An entity that appears, is destroyed or vanishes changes
 * with the later frame. A body that jumped stays in place until then. */
#ifndef JOLON_RENDERER_SCENE_FRAME_FRAME_INTERPOLATION_H
#define JOLON_RENDERER_SCENE_FRAME_FRAME_INTERPOLATION_H

#include "renderer/scene/frame/frame_view.h"

#include <stdbool.h>
#include <stdint.h>

/* Frames farther apart than this many steps are not interpolated. Either pictures are rare or the
 * steps are small, so that the frames themselves look smooth enough. */
#define FRAME_INTERPOLATION_STEPS_MAX 3.5

struct frame_interpolation {
    struct entities
        entities; /* the earlier frame's, with interpolated positions and angles; owned */
};

/* Returns 0, or -1 with errno ENOMEM. */
int frame_interpolation_init(struct frame_interpolation *interpolation, uint32_t capacity);
void frame_interpolation_free(struct frame_interpolation *interpolation);

/* Returns the frame view at a share 0..1 of the time from earlier to later. At 0 and at 1 it is
 * exactly one of them. It is valid until the next call, and as long as both frames. */
struct frame_view frame_interpolation_between(struct frame_interpolation *interpolation,
                                              const struct frame_view *earlier,
                                              const struct frame_view *later, double share);

/* Selects the time to show. It advances evenly although frames are seen a little early or late. */
struct frame_interpolation_clock {
    bool set;
    double rate;
    double ahead_s; /* time of the world minus rate times the time of the clock, when no frame is
                       late */
    double shown_s; /* the last time returned [s] */
};

/* Returns the simulation time to show at time now_s of the clock. It is one step behind the world,
 * and never later than the last frame seen, which is of time newest_s. It does not go back, unless
 * the world itself does: then it is no later than newest_s. rate: seconds of simulation a second; 0
 * if the world is paused or unpaced, and then newest_s is returned. */
double frame_interpolation_time(struct frame_interpolation_clock *clock, double now_s,
                                double newest_s, double step_s, double rate);

#endif
