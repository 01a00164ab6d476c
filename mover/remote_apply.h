/* Records of other simulators (world/entity/remote.h): each is applied once, in the order of the
 * gateway's ring, before any row moves. They have one event for all of a frame, as the recorder
 * reads the records themselves from the ring. */
#ifndef JOLON_MOVER_REMOTE_APPLY_H
#define JOLON_MOVER_REMOTE_APPLY_H

#include "mover/context/serial_context.h"
#include "world/entity/remote.h"

/* Records that a frame takes at most; further ones wait for the next. */
#define REMOTE_APPLY_MOST 4096u

/* Records of a ring that follow one another in a frame. */
struct remote_inputs {
    struct event *event; /* that tells of them; NULL: none yet */
    uint32_t most;       /* intents that a frame may have */
    uint32_t taken;      /* in this frame */
    uint8_t ring;
};

/* Applies the record in a slot. Returns false, and has changed nothing, when the frame has no room
 * for it: it is then the first of the next frame. */
bool remote_apply(struct serial_context *context, struct remote_inputs *inputs,
                  const struct command *slot);

/* Leads the motion of all remote entities, which is by simulated time, to another time scale: their
 * owners go on by the clock. ratio: the scale until now over the new one, above 0. */
void remote_apply_scale(struct serial_context *context, double ratio);

#endif
