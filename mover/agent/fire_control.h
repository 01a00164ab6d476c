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

/* Returns true if a round of row i may harm the committed row target: if it penetrates any side of
 * it. A crew fires at nothing else. */
bool fire_control_harms(const struct step_context *context, uint32_t i, uint32_t target);

/* Returns true if row i fights the committed row target: its munition suits and may harm it, or it
 * rams what it attacks. It takes cover from others. */
bool fire_control_fights(const struct step_context *context, uint32_t i, uint32_t target);

/* Returns from how near the gun of row i, a land vehicle, hits the committed row target and
 * penetrates its front or its sides [m]; INFINITY where the distance does not matter. */
double fire_control_effective_m(const struct step_context *context, uint32_t i, uint32_t target);

/* Returns the range at which row i fires at the committed row target [m]: the range of its gun
 * where a hit is likely, less at aircraft, and less when the rounds are low. */
double fire_control_reach_m(const struct step_context *context, uint32_t i, uint32_t target);

/* Returns true if the committed row target is too far away for the last rounds of row i, which it
 * keeps for what is near. */
bool fire_control_spares(const struct step_context *context, uint32_t i, uint32_t target);

/* Returns true if row i would choose the committed row target, which is at this distance, squared
 * [m^2]. An unarmed row minds every enemy in its sight. */
bool fire_control_worth(const struct step_context *context, uint32_t i, uint32_t target,
                        double square);

/* Returns true if row i has just fired the last round of a salvo, after which a land vehicle
 * changes its place (two to four rounds of a tank) and an aircraft flies home. */
bool fire_control_salvo_over(const struct step_context *context, uint32_t i);

/* Returns from how far row i, a helicopter, fires at the committed row target [m]: from beyond its
 * reach, if that is air defence that the helicopter outranges; 0 for all else. */
double fire_control_outranges_m(const struct step_context *context, uint32_t i, uint32_t target);

/* Returns true if row i is air defence or fires homing missiles, so that aircraft evade it. */
bool fire_control_air_defence(const struct step_context *context, uint32_t i);

/* A burst near row i keeps its crew from firing for 10 to 30 s. Returns the time [s]. */
double fire_control_suppress(const struct step_context *context, uint32_t i);

/* Row i turns to a target that it did not attack before: its gun may fire when the crew has
 * identified the target and laid the gun. The time is drawn at random; its median is the kind's
 * reaction_s. */
void fire_control_acquire(const struct step_context *context, uint32_t i);

#endif
