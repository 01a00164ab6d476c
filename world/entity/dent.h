/* Dents: where collisions bent a vehicle (thesis rows 33, 47). An append-only list in shared memory
 * beside the craters, written by the collider and committed by its count. */
#ifndef JOLON_WORLD_ENTITY_DENT_H
#define JOLON_WORLD_ENTITY_DENT_H

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

/* What is left of a dent's elastic part after so long [m]: elastic_m over the exponential series of
 * age / DENT_RETURN_S up to its fourth power, since exp() is not the same to the bit everywhere. It
 * starts as exp(-age / DENT_RETURN_S) does, at DENT_RETURN_S it is 0.369 where that is 0.368, and
 * after ten times as long less than two thousandths are left. Pure; any thread. */
double crush_elastic_left(double elastic_m, double age_s);

#endif
