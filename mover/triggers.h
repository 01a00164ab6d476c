/* What a row asks for while it moves, in its field `trigger` (TRIGGER_* of
 * mover/context/step_context.h), and what changes other rows or is an event: shots, wrecks that
 * break up, what touches the ground or leaves the world, changes of behaviour. */
#ifndef JOLON_MOVER_TRIGGERS_H
#define JOLON_MOVER_TRIGGERS_H

#include "mover/context/serial_context.h"

#include <stdint.h>

/* Does what row i asks for, if anything, and clears its trigger. On the thread of the step, after
 * all rows have moved. */
void triggers_pull(struct serial_context *context, uint32_t i);

#endif
