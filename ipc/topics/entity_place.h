/* Where an entity of the topics is, and how it moves. Pure; any thread. */
#ifndef JOLON_IPC_TOPICS_ENTITY_PLACE_H
#define JOLON_IPC_TOPICS_ENTITY_PLACE_H

#include "world/entity/told_motion.h"

#include "status.h"

/* Sets the place, the velocity and the angles of an entity to those of a motion. */
static inline void entity_place_set(jolon_Entity *entity, const struct told_motion *motion)
{
    entity->x_m = motion->at.x;
    entity->y_m = motion->at.y;
    entity->z_m = motion->at.z;
    entity->vx_mps = (float)motion->velocity.x;
    entity->vy_mps = (float)motion->velocity.y;
    entity->vz_mps = (float)motion->velocity.z;
    entity->heading_rad = (float)motion->heading_rad;
    entity->pitch_rad = (float)motion->pitch_rad;
    entity->roll_rad = (float)motion->roll_rad;
}

#endif
