/* Vehicles that stand although something presses on them. What the ground resists with before a
 * vehicle begins to move (rolling and the friction of its tracks) takes up what is left of the
 * forces on it: without that a heap that presses would creep for ever. Pure; one thread. */
#ifndef JOLON_COLLIDER_RESTING_STALLED_H
#define JOLON_COLLIDER_RESTING_STALLED_H

#include "collider/resting/resting.h"

/* Marks the bodies that stand in this frame, as resting->stands, and takes their motion. All
 * contacts must have been solved and parted, and nothing moved. */
void stalled_find(struct resting *resting, const struct response_context *context);

/* Puts a row that stands back to where it began the frame, at rest. */
void stalled_stop(struct response_context *context, uint32_t row);

#endif
