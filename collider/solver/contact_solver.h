/* Impulses of the contacts of one moment: rigid bodies, restitution, Coulomb friction, any number
 * of contacts solved together. Linear and angular momentum are conserved to rounding; kinetic
 * energy never grows. Pure; any thread. */
#ifndef JOLON_COLLIDER_SOLVER_CONTACT_SOLVER_H
#define JOLON_COLLIDER_SOLVER_CONTACT_SOLVER_H

#include "world/maths/rotation.h"

#include <stdint.h>

/* inverse_inertia must be symmetric. Along an axis that is held the velocity never changes, so the
 * body may do work there, like a wall that is driven into another body. */
struct solver_body {
    struct vec3 inverse_mass;    /* [1/kg] along each world axis; 0 where it is held */
    struct mat3 inverse_inertia; /* [1/(kg m2)] world axes; 0 where it is held */
    struct vec3 centre;          /* [m] of mass */
    struct vec3 velocity;        /* [m/s] of the centre: in and out */
    struct vec3 spin;            /* [rad/s]: in and out */
    struct vec3 velocity_before; /* the solver's own: the initial values */
    struct vec3 spin_before;
};

/* The solver's own data of a contact, which the caller neither sets nor reads. Vectors are on the
 * contact's axes (normal, first tangent, second tangent) unless stated otherwise. */
struct solver_state {
    struct vec3 arm_a, arm_b; /* [m, world axes] from the centres to the point */
    struct vec3 tangent[2];   /* unit, world axes */
    struct mat3 mobility;     /* [1/kg] speed by a unit impulse; all 0: immovable */
    double slip_mass[2][2];   /* [kg] stops the tangential speed and keeps the normal one */
    struct vec3 before;       /* [m/s] initial velocity of b relative to a */
    double target_mps;        /* least speed along the normal afterwards */
    double plastic_share;     /* of the normal impulse: until the approach ends */
    struct vec3 sum;          /* [N s] the impulse so far */
    struct vec3 step;         /* [N s] its change in the last sweep */
    struct vec3 search;       /* [N s] conjugate direction */
    struct vec3 bouncy;       /* [N s] the impulse with restitution, while that without is sought */
};

struct solver_contact {
    uint32_t a, b;       /* bodies; they differ */
    struct vec3 point;   /* [m] */
    struct vec3 normal;  /* unit, from a towards b */
    double restitution;  /* 0..1 */
    double friction;     /* >= 0, Coulomb's coefficient */
    struct vec3 impulse; /* out [N s]: on b; a gets the opposite */
    double closing_mps;  /* out [m/s]: along the normal before, > 0 for an approach */
    double lost_j;       /* out [J]: its share of the kinetic energy that the island lost, >= 0 */
    struct solver_state state;
};

/* Solves the contacts of one island. Afterwards no contact's bodies approach along its normal (to
 * within 1e-9 of the greatest closing speed), with three exceptions: energy would have to grow for
 * it, both bodies are held, or the bounded number of sweeps does not converge. The bound matters
 * from several hundred contacts on, and where opposite contacts nearly lock their bodies. The order
 * of contacts decides ties and must be the caller's fixed one. Swapping a and b of a contact (and
 * the sign of its normal) changes only the impulse's sign, to the bit.
 *
 * One contact is solved in closed form, after Chatterjee & Ruina, "A New Algebraic Rigid-Body
 * Collision Law Based on Impulse Space Considerations", J. Appl. Mech. 65 (1998): the impulse lies
 * between the frictionless one and the one that ends all slip, as far as the friction cone allows.
 * Several contacts are swept one after the other, each solved alone against the rest (block
 * Gauss-Seidel), with a conjugate search between the sweeps (Silcowitz, Niebe & Erleben, "A
 * nonsmooth nonlinear conjugate gradient method for interactive contact force problems", Vis.
 * Comput. 26, 2010).
 *
 * Where there is no such solution, the laws are relaxed, those of energy and momentum never. An
 * island that friction jams, so that the sweeps do not converge or friction adds energy, is solved
 * with half of the friction, a quarter of it, at last with none. An island in which not all can
 * bounce as they should (between two walls) is solved without restitution. Restitution e returns at
 * most e^2 of the energy that the same impact takes without it. Where restitution and friction
 * together would give the bodies more (Kane's paradox; a body that is wedged between two others),
 * the solution is moved towards the one without restitution just as far as necessary. */
void contact_solver_island(struct solver_body *bodies, uint32_t body_count,
                           struct solver_contact *contacts, uint32_t contact_count);

#endif
