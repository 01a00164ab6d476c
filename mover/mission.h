/* The missions of a world: the one writer of struct battle_state. Part of the serial part of the
 * step, on one thread. What it does follows from the committed battle, the moved table and the tick
 * alone. */
#ifndef JOLON_MOVER_MISSION_H
#define JOLON_MOVER_MISSION_H

#include "mover/context/serial_context.h"

/* Counts who is where, goes on to the next phases, gives the orders of phases that begin, and tells
 * the result when the battle ends. Each mission and each objective has its turn once a second.
 * Returns at once in a world without missions. */
void mission_step(struct serial_context *context);

#endif
