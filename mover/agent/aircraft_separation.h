/* Aircraft keep apart by height.
 *
 * When an agent flies, it looks for other aircraft that come near it within three seconds if both
 * hold their speed, and their bank, which helicopters may also roll out of. Of two such aircraft
 * the higher one stays above and the lower one below. The lower one goes down by half of the gap,
 * as far as the ground allows; the higher one goes up until it has the whole gap below it. One
 * between two others goes up. Both of a pair find the same from the committed table, so they need
 * no agreement; this is how airliners resolve a conflict (RTCA DO-185, TCAS II). Any thread, each
 * its own row. */
#ifndef JOLON_MOVER_AGENT_AIRCRAFT_SEPARATION_H
#define JOLON_MOVER_AGENT_AIRCRAFT_SEPARATION_H

#include "mover/context/step_context.h"

/* Changes the desired height of row i, an aircraft. Returns the height [m] that it should not
 * exceed because another is above it, INFINITY if none is. */
double aircraft_separation_keep(const struct step_context *context, uint32_t i,
                                struct desired_motion *desired);

/* Returns the radius [m] in which one of a kind at this speed is kept from others. */
double aircraft_separation_reach(const struct step_context *context, uint32_t kind,
                                 double speed_mps);

#endif
