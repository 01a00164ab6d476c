/* The control fields of a row that a player or a program drives. */
#ifndef JOLON_MOVER_AGENT_DRIVER_CONTROLS_H
#define JOLON_MOVER_AGENT_DRIVER_CONTROLS_H

#include "mover/context/step_context.h"

/* The motion for which the controls of row i ask. */
void driver_controls_motion(const struct step_context *context, uint32_t i,
                            struct desired_motion *desired);

/* Sets the controls of row i to rest and removes its driver. */
void driver_controls_release(const struct entities *m, uint32_t i);

#endif
