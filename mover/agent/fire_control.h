/* Fire control: at what a crew fires, and how soon. Reads the committed world and row i of the
 * moved table. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_FIRE_CONTROL_H
#define JOLON_MOVER_AGENT_FIRE_CONTROL_H

#include "mover/context/step_context.h"

/* The least time from a crew's first sight of a target to its shot, and that of an agent's reply to
 * a shot [s]: the reaction of an alerted driver (Green 2000). */
#define FIRE_CONTROL_LEAST_S 0.7

/* Returns true if the munition of row i is meant for vehicles such as the committed row target. An
 * unarmed row has no munition, and minds every enemy. */
bool fire_control_suits(const struct step_context *context, uint32_t i, uint32_t target);

/* Row i turns to a target that it did not attack before: its gun may fire when the crew has
 * identified the target and laid the gun. The time is drawn at random; its median is the kind's
 * reaction_s. */
void fire_control_acquire(const struct step_context *context, uint32_t i);

#endif
