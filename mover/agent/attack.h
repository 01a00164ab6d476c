/* Fights: how row i moves and fires in an attack. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_ATTACK_H
#define JOLON_MOVER_AGENT_ATTACK_H

#include "mover/agent/behaviour_table.h"
#include "mover/context/step_context.h"

struct params;

/* What it wants of its body, in the manner of its doctrine. */
void attack_motion(const struct step_context *context, uint32_t i,
                   const struct behaviour_table *table, struct desired_motion *desired);

/* Frames between two shots that an agent with a loaded gun tries. */
uint32_t attack_aim_frames(const struct params *params);

/* Is it about to fire: in an attack, its target in sight and about within range, its gun loaded?
 * Costs next to nothing; whether the gun bears is turret.h's. */
bool attack_ready(const struct step_context *context, uint32_t i);

#endif
