/* An entity as JSON, with the same members in every program. */
#ifndef JOLON_IPC_TOPICS_ENTITY_JSON_H
#define JOLON_IPC_TOPICS_ENTITY_JSON_H

#include "ipc/topics/world_mirror.h"

#include <cjson/cJSON.h>

/* Returns a new object: position and velocity in world axes [m, m/s], angles in degrees. */
cJSON *entity_json(const struct world_mirror *mirror, const jolon_Entity *entity);

#endif
