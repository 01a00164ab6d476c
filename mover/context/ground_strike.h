/* The event of a row that the ground strikes: a wreck that breaks up, an aircraft that touches down
 * hard, a ship that runs aground. */
#ifndef JOLON_MOVER_CONTEXT_GROUND_STRIKE_H
#define JOLON_MOVER_CONTEXT_GROUND_STRIKE_H

#include "mover/context/serial_context.h"
#include "world/entity/event.h"

/* Counts a collision of row i with the ground, and tells it: at this place, along this normal,
 * which points from the row to the ground. The velocity before this frame gives the direction and
 * the closing speed. Returns the event's content, to which the caller adds; NULL if the frame has
 * no room for it. Serial. */
struct event_collision *ground_strike_tell(struct serial_context *context, uint32_t i,
                                           struct vec3 at, struct vec3 normal,
                                           enum response response);

/* The same where the row is, along the normal of the ground there. */
struct event_collision *ground_strike_tell_below(struct serial_context *context, uint32_t i,
                                                 enum response response);

#endif
