/* The state of missions, for status and summary. */
#ifndef JOLON_SUPERVISOR_WORLDCTL_BATTLE_H
#define JOLON_SUPERVISOR_WORLDCTL_BATTLE_H

#include "ipc/json/world_json.h"
#include "world/state.h"

/* Adds the member "battle"; nothing for a world without missions. */
void battle_json(cJSON *object, const struct world *world, const struct state_head *head);

/* Prints lines about objectives and missions; nothing for a world without missions. */
void battle_print(const struct world *world, const struct state_head *head);

#endif
