/* Dents: where collisions bent a vehicle (thesis rows 33, 47). An append-only list in shared memory
 * beside the craters, written by the collider and committed by its count. */
#ifndef JOLON_WORLD_ENTITY_DENT_H
#define JOLON_WORLD_ENTITY_DENT_H

#include <stdint.h>

/* Time in which the elastic part of a dent falls to 1/e [s]. */
#define DENT_RETURN_S 0.5

struct dent {
    uint32_t id;        /* of the entity */
    uint32_t tick;      /* of simulated time at the impact */
    float point[3];     /* [m, body axes] on the undamaged skin */
    float direction[3]; /* unit, body axes: where the skin went */
    float plastic_m;    /* depth that remains: moldability's share */
    float elastic_m;    /* depth at the impact that recovers */
};

_Static_assert(sizeof(struct dent) == 40, "shared layout");

/* Returns how much of a dent's elastic part is left after this time [m]: elastic_m over the
 * exponential series of age / DENT_RETURN_S up to its fourth power, since exp() is not equal to the
 * bit on every machine. It begins like exp(-age / DENT_RETURN_S); at DENT_RETURN_S it is 0.369
 * instead of 0.368, and after ten times as long it is below 0.002. Pure; any thread. */
double crush_elastic_left(double elastic_m, double age_s);

#endif
