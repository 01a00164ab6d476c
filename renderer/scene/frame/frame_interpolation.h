/* Between two committed frames: a renderer draws at a rate of its own, and shows every body where
 * it is at the picture's own time, one frame behind the world. Pure.
 *
 * The state at a time between two frames is that of the earlier one, with the bodies that are in
 * both moved and turned towards where the later one has them. So what appears, is destroyed or is
 * gone changes with the later frame, not before; and what jumped stays until then. */
#ifndef JOLON_RENDERER_SCENE_FRAME_FRAME_INTERPOLATION_H
#define JOLON_RENDERER_SCENE_FRAME_FRAME_INTERPOLATION_H

#include "renderer/scene/frame/frame_view.h"

#include <stdbool.h>
#include <stdint.h>

/* Frames farther apart than so many steps are not blended: pictures come so seldom then, or the
 * world in such small steps, that the frame itself goes evenly enough. */
#define FRAME_INTERPOLATION_STEPS_MAX 3.5

struct frame_interpolation {
    struct entities entities; /* the earlier frame's, but for where bodies are */
    double *columns;          /* [6 * capacity] x, y, z, heading, pitch, roll; owned */
};

/* 0, or -1 with errno ENOMEM. */
int frame_interpolation_init(struct frame_interpolation *interpolation, uint32_t capacity);
void frame_interpolation_free(struct frame_interpolation *interpolation);

/* The moment at share 0..1 of the time from earlier to later: exactly one of them at 0 and at 1.
 * It lives until the next call, and as long as both. */
struct frame_view frame_interpolation_between(struct frame_interpolation *interpolation,
                                              const struct frame_view *earlier,
                                              const struct frame_view *later, double share);

/* Which time to show: it goes on evenly although frames are seen a little early or late. */
struct frame_interpolation_clock {
    bool set;
    double rate;
    double ahead_s; /* the world's time less rate times the clock's, when no frame is late */
};

/* Time of simulation to show at now_s of the clock, one step behind a world of which the frame of
 * newest_s is the last seen and that goes rate seconds a second; never later than newest_s. rate 0
 * (it stands, or goes as fast as it can): newest_s. */
double frame_interpolation_time(struct frame_interpolation_clock *clock, double now_s,
                                double newest_s, double step_s, double rate);

#endif
