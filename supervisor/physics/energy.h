/* Kinetic energy of bodies that touch, from frame to frame. One thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_ENERGY_H
#define JOLON_SUPERVISOR_PHYSICS_ENERGY_H

#include "supervisor/physics/body_look.h"
#include "supervisor/physics/neighbour_pairs.h"

/* A body in the search for groups, and the sums of a group at its first body. */
struct energy_share {
    uint32_t parent;
    bool unexplained; /* no command, explosion or appearance explains a change */
    double gain_j;    /* kinetic energy now, less that before and what engine and weight give */
    double mass_kg;
};

struct energy {
    struct energy_share *share; /* [capacity] */
};

/* Returns 0, or -1 with errno ENOMEM. */
int energy_make(struct energy *energy, uint32_t capacity);
void energy_free(struct energy *energy);

/* Measures the gain of each body and of each group of bodies that the pairs join, per kilogram. */
void energy_look(struct energy *energy, struct measures *measures, const struct body_looks *looks,
                 const struct neighbour_pairs *touching, double dt_s);

#endif
