/* The smoke grenades of armoured land vehicles. The field owner_slot of a vehicle, which only
 * munitions need otherwise, is the frame in which it last fired them; 0: never. The mover asks
 * whether the smoke hides it, and pictures show it. Pure; any thread. */
#ifndef JOLON_WORLD_ENTITY_SMOKE_H
#define JOLON_WORLD_ENTITY_SMOKE_H

#include "world/entity/entity.h"
#include "world/entity/kind.h"

#define SMOKE_GROWS_S 1.5   /* from the salvo until the smoke hides the vehicle */
#define SMOKE_S       15.0  /* and until it hides it no more: it drives out of its screen */
#define SMOKE_AGAIN_S 180.0 /* the crew needs this time to load the launchers again */
#define SMOKE_SLOPE   0.3   /* over a screen 9 m high and 30 m away: those who look down see all */

/* Returns the time [s] since row i fired its grenades, INFINITY if it never has. */
static inline double smoke_age_s(const struct entities *entities, const struct kind *kind,
                                 uint32_t i, uint64_t tick, double dt_s)
{
    if (entities->row[i].owner_slot == 0 || kind->domain != DOMAIN_LAND)
        return INFINITY;
    return (double)((uint32_t)tick - entities->row[i].owner_slot) * dt_s;
}

/* Returns true if the smoke of row i is between it and whatever is at this place relative to it
 * [m], so that neither sees the other. */
static inline bool smoke_hides(const struct entities *entities, const struct kind *kind, uint32_t i,
                               struct vec3 to, uint64_t tick, double dt_s)
{
    double age = smoke_age_s(entities, kind, i, tick, dt_s);
    return age >= SMOKE_GROWS_S && age < SMOKE_S &&
           to.y < SMOKE_SLOPE * sqrt(to.x * to.x + to.z * to.z);
}

#endif
