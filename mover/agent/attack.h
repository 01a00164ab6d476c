/* How row i moves and fires in an attack. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_ATTACK_H
#define JOLON_MOVER_AGENT_ATTACK_H

#include "mover/agent/behaviour_table.h"
#include "mover/context/step_context.h"

struct params;

/* The desired motion, in the manner of its doctrine's table. */
void attack_motion(const struct step_context *context, uint32_t i,
                   const struct behaviour_table *table, struct desired_motion *desired);

/* The number of frames from one attempt to fire to the next. */
uint32_t attack_aim_frames(const struct params *params);

/* Returns true if it is about to fire: it attacks, the target is in sight and nearly in range, its
 * rounds may harm it, and the gun is loaded. turret_hold_fire() then checks the gun's direction. */
bool attack_ready(const struct step_context *context, uint32_t i);

#endif
