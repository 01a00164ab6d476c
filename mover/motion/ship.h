/* Motion of ships: they stay on the water, and run aground by their bow.
 *
 * The rudder gives a circle, so the rate of turn grows with the speed: the kind's turn rate is that
 * at top speed. Drag grows with the square of the speed and with the rudder. A ship whose engines
 * stop runs on for a long way. It heels out of a turn. The heel shows where the rudder is, so the
 * rudder needs no column of its own. */
#ifndef JOLON_MOVER_MOTION_SHIP_H
#define JOLON_MOVER_MOTION_SHIP_H

#include "mover/context/step_context.h"

/* Returns true when land or the edge of the world blocks the ship. The friction of the shore then
 * stops it, while the leading end of its hull slides ashore. Its position stays on the water. */
bool ship_move(const struct step_context *context, uint32_t i,
               const struct desired_motion *desired);

#endif
