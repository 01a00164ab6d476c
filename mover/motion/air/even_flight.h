/* Stretches of aircraft in a crowd (world/entity/cruise.h), whose agents decide seldom.
 *
 * The motion of one frame (mover/motion/aircraft.h) follows controls, lags and the ground step by
 * step, which is crude for a frame of two seconds. This one is even: turn, speed and climb change
 * at constant rates, within what the airframe gives, and bank and pitch from what they are to what
 * the end needs. The climb at the end is the one that the motion of a frame would want there. It is
 * more where the aircraft would else not keep three quarters of its height over all ground of its
 * way and of three seconds after it.
 *
 * Refused is what asks for more: a turn or a lean that is large, a climb that changes too fast or
 * leaves less than half of the height, and a way on which the body may come nearer than 3 m to the
 * ground. The ground is looked at every half second, and between by the steepest slope of the
 * gridsquares. Any thread, each its own row. */
#ifndef JOLON_MOVER_MOTION_EVEN_FLIGHT_H
#define JOLON_MOVER_MOTION_EVEN_FLIGHT_H

#include "mover/context/step_context.h"

/* Returns the frames, at most this many, of a stretch of row i that delays no decision which keeps
 * it from another aircraft: it ends three seconds before one may come near, but it need not be
 * shorter than cruise_short, nor than the time between two decisions. */
uint32_t even_flight_frames(const struct step_context *context, uint32_t i, uint32_t frames);

/* Moves row i, an aircraft that an agent flies, by a stretch of so many frames. Returns false, and
 * leaves the row as it is, if that is refused. */
bool even_flight_begin(const struct step_context *context, uint32_t i,
                       const struct desired_motion *desired, uint32_t frames);

#endif
