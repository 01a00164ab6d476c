/* What phases of missions wait for. Serial part of the step. */
#ifndef JOLON_MOVER_MISSION_CONDITIONS_H
#define JOLON_MOVER_MISSION_CONDITIONS_H

#include "mover/context/serial_context.h"
#include "world/entity/mission.h"

/* Counts the vehicles that were in an objective when the frame began, and changes its owner.
 * Returns the owner before. */
enum force mission_conditions_count(const struct serial_context *context, uint32_t objective);

/* Returns how many vehicles of a mission are active. */
uint32_t mission_conditions_able(const struct serial_context *context,
                                 const struct mission *mission);

/* Returns true if the member is active and still the vehicle that the scenario made. */
bool mission_conditions_active(const struct serial_context *context, uint32_t slot);

/* Returns true if the row is in the area of a phase, or at the end of its route. */
bool mission_conditions_there(const struct serial_context *context,
                              const struct battle_phase *phase, uint32_t row);

/* Returns true if one of the conditions holds for a mission. phase: of its order. */
bool mission_conditions_hold(const struct serial_context *context, uint32_t mission,
                             const struct battle_phase *phase,
                             const struct mission_conditions *conditions);

#endif
