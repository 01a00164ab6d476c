/* Impulses at contacts that happen at one moment: rigid bodies, restitution, Coulomb friction, any
 * number of contacts solved together. Linear and angular momentum are kept to rounding; kinetic
 * energy never grows. Pure; any thread. */
#ifndef JOLON_COLLIDER_SOLVE_H
#define JOLON_COLLIDER_SOLVE_H

#include "world/rotation.h"

#include <stdint.h>

struct solve_body {
    struct vec3 inverse_mass;    /* [1/kg] along each world axis; 0 where something holds it */
    struct mat3 inverse_inertia; /* [1/(kg m2)] world axes; 0 where something holds it */
    struct vec3 centre;          /* [m] of mass */
    struct vec3 velocity;        /* [m/s] of the centre: in and out */
    struct vec3 spin;            /* [rad/s]: in and out */
};

struct solve_contact {
    uint32_t a, b;       /* bodies */
    struct vec3 point;   /* [m] */
    struct vec3 normal;  /* unit, from a towards b */
    double restitution;  /* 0..1 */
    double friction;     /* >= 0, Coulomb's coefficient */
    struct vec3 impulse; /* out [N s] on b; on a the opposite */
    double closing_mps;  /* out: along the normal before, > 0 when coming nearer */
    double lost_j;       /* out: its share of the kinetic energy that the island lost, >= 0 */
};

/* Solves the contacts of one island: afterwards no contact's bodies come nearer along its normal
 * (to within 1e-9 of the fastest closing speed) unless energy would have to grow for it. The order
 * of contacts decides ties and must be the caller's fixed one; swapping a and b of a contact (and
 * its normal) changes no result but the impulse's sign. */
void solve_island(struct solve_body *bodies, uint32_t body_count, struct solve_contact *contacts,
                  uint32_t contact_count);

#endif
