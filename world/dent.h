/* Dents: where collisions bent a vehicle (thesis rows 33, 47). An append-only list in shared memory
 * beside the craters, written by the collider and committed by its count. */
#ifndef JOLON_WORLD_DENT_H
#define JOLON_WORLD_DENT_H

#include <stdint.h>

/* Time in which the elastic part of a dent comes back to 1/e of itself [s]. */
#define DENT_RETURN_S 0.5

struct dent {
    uint32_t id;        /* of the entity */
    uint32_t tick;      /* of simulated time when it came */
    float point[3];     /* [m, body axes] on the skin as it was */
    float direction[3]; /* unit, body axes: where the skin went */
    float plastic_m;    /* depth that stays: moldability's share */
    float elastic_m;    /* depth at the impact that comes back */
};

_Static_assert(sizeof(struct dent) == 40, "shared layout");

#endif
