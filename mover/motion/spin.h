/* Rotation that a collision gave to a body. */
#ifndef JOLON_MOVER_MOTION_SPIN_H
#define JOLON_MOVER_MOTION_SPIN_H

#include "mover/context/step_context.h"

/* Turns row i by its spin fields for the frame and slows the spin. A body on the ground or on the
 * water turns about the vertical only, a body in the air about its centre of mass. True when there
 * was a spin. */
bool spin_row(const struct step_context *context, uint32_t i);

#endif
