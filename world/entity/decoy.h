/* Decoys: the flares of aircraft and ships and the smoke of land vehicles that a homing missile
 * comes near. The mover asks whether they take the seeker, and pictures show them. Pure; any
 * thread. */
#ifndef JOLON_WORLD_ENTITY_DECOY_H
#define JOLON_WORLD_ENTITY_DECOY_H

#include "world/entity/entity.h"

#define DECOY_RELEASED_S 3.7 /* the first decoys leave so long before the missile arrives */
#define DECOY_S          2.5 /* now they burn or have spread, and may take its seeker */

/* Returns true if a missile that comes near will arrive within a time and the target releases
 * decoys against it. One that reacts to nothing releases none. to: [m] from the missile to the
 * target; closing: [m/s] the velocity of the target relative to the missile. */
static inline bool decoy_due(const struct entities *entities, uint32_t target, struct vec3 to,
                             struct vec3 closing, double within_s)
{
    double near = -vec3_dot(to, closing) * within_s;
    return entities->row[target].state == ENTITY_ACTIVE &&
           entities->row[target].behaviour != BEHAVIOUR_HOLD && vec3_dot(to, to) <= near;
}

#endif
