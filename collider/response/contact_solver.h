/* Impulses at contacts that happen at one moment: rigid bodies, restitution, Coulomb friction, any
 * number of contacts solved together. Linear and angular momentum are kept to rounding; kinetic
 * energy never grows. Pure; any thread. */
#ifndef JOLON_COLLIDER_RESPONSE_CONTACT_SOLVER_H
#define JOLON_COLLIDER_RESPONSE_CONTACT_SOLVER_H

#include "world/maths/rotation.h"

#include <stdint.h>

/* inverse_inertia must be symmetric. An axis that is held keeps what velocity it has, whatever it
 * meets, and may so do work, as a wall that is driven into somebody does. */
struct solver_body {
    struct vec3 inverse_mass;    /* [1/kg] along each world axis; 0 where something holds it */
    struct mat3 inverse_inertia; /* [1/(kg m2)] world axes; 0 where something holds it */
    struct vec3 centre;          /* [m] of mass */
    struct vec3 velocity;        /* [m/s] of the centre: in and out */
    struct vec3 spin;            /* [rad/s]: in and out */
    struct vec3 velocity_before; /* the solver's own: as they came in */
    struct vec3 spin_before;
};

/* The solver's own on a contact; the caller neither sets nor reads it. Vectors are on the
 * contact's axes, (normal, first tangent, second tangent), unless they say otherwise. */
struct solver_state {
    struct vec3 arm_a, arm_b; /* [m, world axes] from the centres to the point */
    struct vec3 tangent[2];   /* unit, world axes */
    struct mat3 mobility;     /* [1/kg] speed that an impulse gives; all 0: immovable */
    double slip_mass[2][2];   /* [kg] stops tangential speed, the normal one being kept */
    struct vec3 before;       /* [m/s] of b off a, at first */
    double target_mps;        /* along the normal, at least, afterwards */
    double plastic_share;     /* of the normal impulse: up to where the bodies stop closing */
    struct vec3 sum;          /* [N s] the impulse so far */
    struct vec3 step;         /* [N s] what the last sweep changed of it */
    struct vec3 search;       /* [N s] conjugate direction */
    struct vec3 bouncy;       /* [N s] sum with restitution, while the one without is sought */
};

struct solver_contact {
    uint32_t a, b;       /* bodies, two different ones */
    struct vec3 point;   /* [m] */
    struct vec3 normal;  /* unit, from a towards b */
    double restitution;  /* 0..1 */
    double friction;     /* >= 0, Coulomb's coefficient */
    struct vec3 impulse; /* out [N s] on b; on a the opposite */
    double closing_mps;  /* out: along the normal before, > 0 when coming nearer */
    double lost_j;       /* out: its share of the kinetic energy that the island lost, >= 0 */
    struct solver_state notes;
};

/* Solves the contacts of one island: afterwards no contact's bodies come nearer along its normal
 * (to within 1e-9 of the fastest closing speed) unless energy would have to grow for it, both are
 * held that way, or the sweeps below end unsettled: their number is bounded, which is felt from
 * several hundred contacts on and where contacts that face each other all but lock their bodies.
 * The order of contacts decides ties and must be the caller's fixed one; swapping a and b of a
 * contact (and its normal) changes no result but the impulse's sign, to the bit.
 *
 * One contact is solved in closed form, after Chatterjee & Ruina, "A New Algebraic Rigid-Body
 * Collision Law Based on Impulse Space Considerations", J. Appl. Mech. 65 (1998): the impulse lies
 * between the frictionless one and the one that ends all slip, as far as the friction cone reaches.
 * Several are swept one after the other, each solved alone against the rest (block Gauss-Seidel),
 * with a conjugate search between the sweeps (Silcowitz, Niebe & Erleben, "A nonsmooth nonlinear
 * conjugate gradient method for interactive contact force problems", Vis. Comput. 26, 2010).
 *
 * Where that has no answer the laws give way, energy's and momentum's last: an island that friction
 * jams, so that the sweeps never settle, is solved with half of it, a quarter of it, at last
 * without; one in which not all can bounce as they should (between two walls) without restitution;
 * and where restitution and friction together would add energy (Kane's paradox), the answer is
 * drawn towards the one without restitution just as far as it takes. */
void contact_solver_island(struct solver_body *bodies, uint32_t body_count,
                           struct solver_contact *contacts, uint32_t contact_count);

#endif
