/* A frame stepper: computes frames of a world in this process's own memory (segment_private) with
 * the steps of mover and collider, without a clock, doorbells or other processes. Its frames are
 * bit-identical to those that the roles compute from the same world and commands. */
#ifndef JOLON_RECORDER_REPLAY_FRAME_STEPPER_H
#define JOLON_RECORDER_REPLAY_FRAME_STEPPER_H

#include "collider/step.h"
#include "ipc/segment/segment.h"
#include "mover/step.h"
#include "world/runtime/thread_pool.h"

#include <stdint.h>

struct frame_stepper {
    struct view *view; /* the caller's; writable */
    struct thread_pool *workers;
    struct mover mover;
    struct collider collider;
};

/* The view is filled (segment_fill, image_load) and stays where it is until frame_stepper_free().
 * threads: 1..THREAD_POOL_MAX. Returns 0, or -1 with errno ENOMEM or EAGAIN and nothing to free. */
int frame_stepper_init(struct frame_stepper *stepper, struct view *view, uint32_t threads);
void frame_stepper_free(struct frame_stepper *stepper);

/* The commands that the mover would take now: each ring of the view up to its head. */
void frame_stepper_sources(const struct view *view,
                           struct command_source sources[COMMAND_RING_COUNT]);

/* Computes and commits the frame after the committed one, with the commands of sources (NULL:
 * frame_stepper_sources()). If the moved table already holds that frame, its move is not
 * repeated. */
void frame_stepper_step(struct frame_stepper *stepper, const struct command_source *sources);

/* The two halves of a step. The first computes the moved table anew; the second collides and
 * commits what the moved table holds. */
void frame_stepper_move(struct frame_stepper *stepper, const struct command_source *sources);
void frame_stepper_collide(struct frame_stepper *stepper);

/* The last committed frame. */
uint64_t frame_stepper_frame(const struct frame_stepper *stepper);

#endif
