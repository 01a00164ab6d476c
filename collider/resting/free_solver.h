/* Sequential impulses for contacts of which one body is free: it can move and turn in every
 * direction. The other one is free, too, or the ground holds it, or it is fixed.
 *
 * No point closes by more than its gap within the frame (a speculative contact), and nothing
 * bounces. Friction acts across the normal, within the friction cone. Bodies resist rolling on each
 * other. The impulses of a frame begin at 0, and the points are swept until they settle, a bounded
 * number of times, in turn forwards and backwards: E. Catto, "Iterative Dynamics with Temporal
 * Coherence", GDC 2005. Overlaps are recovered by velocities of their own that are then forgotten
 * (split impulses). Pure; any thread. */
#ifndef JOLON_COLLIDER_RESTING_FREE_SOLVER_H
#define JOLON_COLLIDER_RESTING_FREE_SOLVER_H

#include "world/maths/rotation.h"

#include <stdbool.h>
#include <stdint.h>

/* A velocity of the centre of mass [m/s] and a spin [rad/s, world axes]. */
struct free_motion {
    struct vec3 velocity, spin;
};

/* The impulses by which the ground keeps a held body at its motion: along its heading and across
 * it [N s], and about the vertical [N m s]. */
struct free_grip {
    double along, across, turn;
};

struct free_body {
    double inverse_mass; /* [1/kg]; 0: fixed */
    struct mat3
        inverse_inertia;       /* [1/(kg m2)] world axes; of a held body about the vertical only */
    bool held;                 /* impulses move it along the ground only */
    struct free_motion moved;  /* in: without the contacts; out: with them */
    struct free_motion pushed; /* out: what parts overlapping bodies, in addition */
    struct vec3 up;            /* unit: across the ground along which a held body moves */
    struct vec3 forward;       /* unit, horizontal: the heading of a held body */
    struct free_grip most;     /* of a held body, in this frame */
    struct free_motion wanted; /* the solver's own: moved as it was given */
    struct free_grip grip;     /* the solver's own: impulses of the ground so far */
};

enum { FREE_NORMAL, FREE_ALONG, FREE_ACROSS, FREE_AXES };

struct free_contact {
    uint32_t a, b;                /* bodies; they differ */
    struct vec3 normal;           /* unit, from a to b */
    struct vec3 arm_a, arm_b;     /* [m] from the centres of mass to the point */
    double least_mps;             /* speed along the normal afterwards, at least */
    double apart_mps;             /* speed at which an overlap is recovered; 0: no overlap */
    double friction;              /* Coulomb's coefficient */
    double rolling_m;             /* lever with which the point resists rolling */
    double impulse_ns[FREE_AXES]; /* out */
    struct vec3 axis[FREE_AXES];  /* the solver's own, like the rest */
    struct vec3 twist_a[FREE_AXES], twist_b[FREE_AXES]; /* [1/(kg m)] spin by a unit impulse */
    double mass_kg[FREE_AXES];
    struct vec3 rolling_nms;
    double push_ns;
    bool crossed; /* the caller's own */
};

/* Solves the contacts. The result depends on their order, which must be the caller's fixed one. */
void free_solver_run(struct free_body *body, uint32_t bodies, struct free_contact *contact,
                     uint32_t contacts);

/* Returns the speed at which the bodies of a contact close at its point [m/s], below 0 if they
 * part. */
double free_solver_closing(const struct free_body *body, const struct free_contact *contact);

#endif
