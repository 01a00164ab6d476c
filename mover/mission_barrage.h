/* Barrages of missions: fire missions of howitzers, of a battery off the map, or of guns that fire
 * directly. Serial part of the step. */
#ifndef JOLON_MOVER_MISSION_BARRAGE_H
#define JOLON_MOVER_MISSION_BARRAGE_H

#include "mover/context/serial_context.h"
#include "world/entity/mission.h"

/* Fires what mission `index`, whose present phase has the order "barrage", is to fire in this
 * second. Called once in second_ticks. */
void mission_barrage(struct serial_context *context, uint32_t index,
                     const struct battle_phase *phase, uint32_t second_ticks);

#endif
