/* Aircraft keep clear of the ground before them.
 *
 * Aeroplanes. The motion of an aircraft looks three seconds ahead (mover/motion/aircraft.h), a
 * pilot half a minute: along the way that the aeroplane will fly, which is the turn to the heading
 * that it wants, and then straight on. For each place there it computes the rate of climb at which
 * the aeroplane is high enough when it comes there, with the height that it loses until a descent
 * has ended. It climbs in time. Where the climb that it relies on does not suffice it turns another
 * way: the nearest to the heading that it wants over which it can climb, or the best of them. It
 * climbs meanwhile, and tries again when it decides again.
 *
 * Helicopters. They fly so low that they look at the ground itself (world/terrain/climb_ahead.h),
 * as far as they need to stop. They climb in time, too, and where the climb does not suffice they
 * slow down, to a hover if need be. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_FLIGHT_TERRAIN_FOLLOWING_H
#define JOLON_MOVER_AGENT_FLIGHT_TERRAIN_FOLLOWING_H

#include "mover/context/step_context.h"

/* Changes the desired heading and height of row i, an aeroplane of an agent or a script. That of an
 * agent stays below highest_m [m], a height like the desired one, while the ground leaves it time
 * to climb later. */
void terrain_following_steer(const struct step_context *context, uint32_t i, double highest_m,
                             struct desired_motion *desired);

/* Changes the desired heading, height and speed of row i, a helicopter of an agent or a script. One
 * that wants the height 0 sets down and is left alone. */
void terrain_following_hover(const struct step_context *context, uint32_t i,
                             struct desired_motion *desired);

#endif
