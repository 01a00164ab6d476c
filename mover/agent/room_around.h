/* What stands around a land vehicle on wheels, as obstacles of the room in which it turns. Any
 * thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_ROOM_AROUND_H
#define JOLON_MOVER_AGENT_ROOM_AROUND_H

#include "mover/agent/driving/shunting_room.h"
#include "mover/context/step_context.h"

#define ROOM_AROUND_STANDS_MPS 0.5 /* a vehicle that is slower stands in the room */

/* Returns the room of row i: fixed objects, vehicles that stand with their guns, and craters,
 * within two of its tightest circles. */
struct shunting_room room_around(const struct step_context *context, uint32_t i);

#endif
