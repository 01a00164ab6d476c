/* The losses of a vehicle's group. Reads the committed world. Any thread. */
#ifndef JOLON_MOVER_AGENT_LOSSES_H
#define JOLON_MOVER_AGENT_LOSSES_H

#include "mover/context/step_context.h"

/* Returns true if half of row i's group is destroyed. A group is a formation, or the vehicles of
 * one kind, force and order in consecutive slots, which a scenario's entry with a count makes.
 * Groups of fewer than four have no such limit. At most 64 vehicles on each side of the row are
 * counted. */
bool losses_half(const struct step_context *context, uint32_t i);

#endif
