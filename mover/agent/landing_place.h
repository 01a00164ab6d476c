/* Whether a helicopter can set down where it is. Pure; any thread. */
#ifndef JOLON_MOVER_AGENT_LANDING_PLACE_H
#define JOLON_MOVER_AGENT_LANDING_PLACE_H

#include "mover/context/step_context.h"

/* Returns true if the ground under row i is dry and nearly level as far as the aircraft reaches,
 * and if neither a fixed object nor another vehicle stands there. */
bool landing_place_is_clear(const struct step_context *context, uint32_t i);

#endif
