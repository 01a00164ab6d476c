/* Motion of remote entities: dead reckoning from what their owner told last. The collider corrects
 * errors of place and attitude when the frame ends (collider/remote_rows.h), as a correction is no
 * motion. world/entity/remote.h has the fields.
 *
 * Every model has a constant state in axes that turn evenly or not at all. So a frame leads the row
 * to a state of the same model, and n frames give what the formula gives after their time. */
#ifndef JOLON_MOVER_MOTION_REMOTE_MOTION_H
#define JOLON_MOVER_MOTION_REMOTE_MOTION_H

#include "mover/context/step_context.h"

/* Moves row i by one frame. Returns false if it has left the world. Any thread. */
bool remote_motion_move(const struct step_context *context, uint32_t i);

/* Returns true if row i stands by its model: it changes only by a record, or by being corrected. */
bool remote_motion_stands(const struct entities *m, uint32_t i);

#endif
