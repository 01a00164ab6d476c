/* Whether the driver of an aircraft has to pull up. Pure; any thread. */
#ifndef JOLON_WORLD_PULL_UP_H
#define JOLON_WORLD_PULL_UP_H

#include "world/entity/entity.h"
#include "world/world.h"

/* Returns true if row i, an aircraft that is driven, strikes the ground unless its driver pulls up
 * or, of a helicopter, brakes within two seconds. Goes by its way in its present turn and by the
 * uncratered ground (world/terrain/climb_ahead.h). A sink rate of a gentle touch-down is none to
 * warn of. */
bool pull_up_of(const struct world *world, const struct entities *entities, uint32_t i);

#endif
