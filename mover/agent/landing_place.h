/* Where a helicopter sets down at its base, and whether it can. Pure; any thread. */
#ifndef JOLON_MOVER_AGENT_LANDING_PLACE_H
#define JOLON_MOVER_AGENT_LANDING_PLACE_H

#include "mover/context/step_context.h"

/* Moves the point from the middle of the base of row i, a helicopter, to its place there. Places
 * are on a spiral, about 70 m apart: that of its id, or the next of a few others of its own where a
 * vehicle stands there, or an aircraft of a lower row comes to it. */
void landing_place_find(const struct step_context *context, uint32_t i, double *x, double *z);

/* Returns true if the ground under row i is dry and nearly level as far as the aircraft reaches,
 * and if neither a fixed object nor another vehicle stands there. */
bool landing_place_is_clear(const struct step_context *context, uint32_t i);

#endif
