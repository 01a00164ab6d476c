/* Motion of remote entities: dead reckoning from what their owner told last, and the errors of
 * place and attitude, which vanish within REMOTE_MOTION_SMOOTH_S (world/entity/remote.h has the
 * columns).
 *
 * Every model has a constant state in axes that turn evenly or not at all. So a frame leads the row
 * to a state of the same model, and n frames give what the formula gives after their time. */
#ifndef JOLON_MOVER_MOTION_REMOTE_MOTION_H
#define JOLON_MOVER_MOTION_REMOTE_MOTION_H

#include "mover/context/step_context.h"

/* An error of place or attitude vanishes in this time [s]. */
#define REMOTE_MOTION_SMOOTH_S 0.25

/* A clamped land vehicle is set on the ground if it is this near [m]. */
#define REMOTE_MOTION_CLAMP_M 30.0

/* Moves row i by one frame. Returns false if it has left the world. Any thread. */
bool remote_motion_move(const struct step_context *context, uint32_t i);

/* Sets a place on our ground if it is one of a land vehicle and near the ground. Returns true if it
 * was. */
bool remote_motion_clamp(const struct step_context *context, uint16_t kind, struct vec3 *at);

#endif
