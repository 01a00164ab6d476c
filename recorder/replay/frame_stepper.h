/* A frame stepper: mover's and collider's steps on a world in this process's own memory
 * (segment_private), frame by frame, without a clock, doorbells or other processes. The frame that
 * it makes is to the bit the one that the roles make of the same world and commands. */
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

/* On a view that is filled (segment_fill, image_load) and stays where it is until
 * frame_stepper_free. threads 1..THREAD_POOL_MAX. 0; -1 with errno ENOMEM or EAGAIN and nothing to
 * free. */
int frame_stepper_init(struct frame_stepper *stepper, struct view *view, uint32_t threads);
void frame_stepper_free(struct frame_stepper *stepper);

/* What the mover would take now: each ring of the view up to its head. */
void frame_stepper_sources(const struct view *view,
                           struct command_source sources[COMMAND_RING_COUNT]);

/* The frame after the committed one: moved with the commands of sources (NULL:
 * frame_stepper_sources()), which a moved table that holds that frame already makes superfluous;
 * collided; committed. */
void frame_stepper_step(struct frame_stepper *stepper, const struct command_source *sources);

/* The two halves of it: the moved table anew, whatever it holds; the commit of what it holds. */
void frame_stepper_move(struct frame_stepper *stepper, const struct command_source *sources);
void frame_stepper_collide(struct frame_stepper *stepper);

/* The last committed frame. */
uint64_t frame_stepper_frame(const struct frame_stepper *stepper);

#endif
