/* How fast a crew drives on the ground before it.
 *
 * A crew slows down for five things: ground that slopes to the side and leaves little of the margin
 * against sliding and turning over; a way down on which the brakes hold less; the faces of
 * earthworks, such as a step; the bends of its route; and being thrown about. It brakes in time:
 * within its way to a stop it looks at four places of the ground and at the next bends. Pure; any
 * thread. */
#ifndef JOLON_MOVER_AGENT_DRIVING_DRIVING_PACE_H
#define JOLON_MOVER_AGENT_DRIVING_DRIVING_PACE_H

#include "mover/context/step_context.h"

/* Returns the greatest speed [m/s] at which the crew of row i, a land vehicle, drives along this
 * heading; INFINITY: the ground does not limit it. */
double driving_pace(const struct step_context *context, uint32_t i, double heading_rad);

#endif
