/* The engines of aircraft that are driven: they follow the throttle with a lag, and the field
 * dodge is by how much they are below their full power (mover/motion/airframe.h). Pure; any thread.
 */
#ifndef JOLON_WORLD_ENTITY_SPOOL_H
#define JOLON_WORLD_ENTITY_SPOOL_H

#include "world/entity/entity.h"
#include "world/entity/kind.h"

/* Returns how much of its power the engine of row i gives at most, 0..1. Below 1 only of an
 * aircraft that is driven. */
static inline double spool_of(const struct entities *entities, const struct kind *kind, uint32_t i)
{
    bool lags = entities->row[i].behaviour == BEHAVIOUR_DRIVEN && kind->domain == DOMAIN_AIR;
    return lags ? 1.0 - (double)entities->row[i].dodge : 1.0;
}

#endif
