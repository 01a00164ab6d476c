/* What a row asks for while it moves, in its column `trigger` (TRIGGER_* of
 * mover/context/step_context.h), and what changes other rows or is an event: shots, wrecks that
 * break up, what touches the ground or leaves the world, changes of behaviour. */
#ifndef JOLON_MOVER_TRIGGERS_H
#define JOLON_MOVER_TRIGGERS_H

#include "mover/context/serial_context.h"

#include <stdint.h>

/* Does what the rows from first to end - 1 ask for, in their order, and clears their triggers. On
 * the thread of the step, after all rows have moved. */
void triggers_pull(struct serial_context *context, uint32_t first, uint32_t end);

#endif
