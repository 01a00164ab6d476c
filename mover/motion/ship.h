/* Motion of ships: they stay on the water, and run aground.
 *
 * The rudder gives a circle, so the rate of turn grows with the speed: the kind's turn rate is that
 * at top speed. Drag grows with the square of the speed and with the rudder. A ship whose engines
 * stop runs on for a long way. It heels out of a turn. The heel shows where the rudder is, so the
 * rudder needs no field of its own.
 *
 * A ship is aground while an end of its hull is on land: ENTITY_FLAG_AGROUND. The friction of the
 * shore stops it while it slides up, and adds the energy that it takes to harm_j, of which the
 * collider makes damage. It does not turn there. Its screws pull it off if they are stronger than
 * the friction of the part that is ashore; for the kind ship that is up to half of its length. The
 * edge of the world stops a ship in the same way, without harm. */
#ifndef JOLON_MOVER_MOTION_SHIP_H
#define JOLON_MOVER_MOTION_SHIP_H

#include "mover/context/serial_context.h"
#include "mover/context/step_context.h"

struct ship_moved {
    bool blocked; /* land or the edge of the world stops it on its way */
    bool touched; /* it is or was aground: flags, trigger and harm_j may have changed */
};

/* Moves row i for a frame. */
struct ship_moved ship_move(const struct step_context *context, uint32_t i,
                            const struct desired_motion *desired);

/* Moves row i by a stretch of so many frames (world/entity/cruise.h). Returns false if that is
 * refused, for a way that is not even or that leads to the shore or the edge of the world: the row
 * then stays as it is. */
bool ship_stretch(const struct step_context *context, uint32_t i,
                  const struct desired_motion *desired, uint32_t frames);

/* Row i holds its course. Changes its velocity if it is aground; its position stays. Returns true
 * if flags, trigger and harm_j may have changed. */
bool ship_hold(const struct step_context *context, uint32_t i);

/* Tells in an event that row i has run aground in this frame. Serial. */
void ship_tell_aground(struct serial_context *context, uint32_t i);

#endif
