/* Smoke grenades against gunners. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_SMOKE_SCREEN_H
#define JOLON_MOVER_AGENT_SMOKE_SCREEN_H

#include "mover/context/step_context.h"

/* The crew of row i fires its smoke grenades, if it has any: armoured vehicles and air defence,
 * once in SMOKE_AGAIN_S. */
void smoke_screen_fire(const struct step_context *context, uint32_t i);

/* Returns true if the smoke of one of the two rows keeps them from seeing each other. */
bool smoke_screen_between(const struct step_context *context, uint32_t a, uint32_t b);

#endif
