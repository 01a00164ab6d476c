/* Sequential impulses for contacts that last, among bodies that the ground holds: they move
 * horizontally and turn about the vertical.
 *
 * No contact point closes by more than its gap within the frame: the speed along the normal is at
 * least -(gap - skin) / dt (a speculative contact). Friction acts across the normal, within the
 * friction cone. The ground resists what would move a body away from its mover's motion, within
 * its grip. The impulses of a frame begin where the caller says, which is a share of those of the
 * frame before (warm start), and the points are swept in turn forwards and backwards, until they
 * have come to rest or a fixed number of times: E. Catto, "Iterative Dynamics with Temporal
 * Coherence", GDC 2005. A warm start can end with more energy than the bodies began with. Then all
 * is solved again with impulses that begin at 0 (cold start), by which energy never grows.
 *
 * Overlaps are recovered by a second set of velocities that moves bodies and leaves their momentum
 * alone (split impulses). So recovery adds no energy. Pure; any thread, each with lanes of its own.
 */
#ifndef JOLON_COLLIDER_SOLVER_LEVEL_SOLVER_H
#define JOLON_COLLIDER_SOLVER_LEVEL_SOLVER_H

#include "collider/solver/level_lanes.h"

#include <stdint.h>

/* Sweeps at most, from impulses of the frame before and from 0. */
#define LEVEL_SOLVER_WARM_SWEEPS 10
#define LEVEL_SOLVER_COLD_SWEEPS 30

/* Sweeps at most that recover overlaps. */
#define LEVEL_SOLVER_PART_SWEEPS 20

/* A sweep in which no point changes its speed by more is the last one [m/s]. */
#define LEVEL_SOLVER_ENOUGH_MPS 1e-7

/* Motion in the plane: velocities [m/s], and the spin about the vertical [rad/s], upwards by the
 * right hand. */
struct level_motion {
    double x, z, spin;
};

struct level_body {
    double inverse_mass;         /* [1/kg]; 0: fixed */
    double inverse_moment;       /* [1/(kg m2)] about the vertical; above 0 unless fixed */
    struct level_motion moved;   /* in: by the mover; out: after the contacts */
    struct level_motion pushed;  /* out: what moves overlapping bodies apart, in addition */
    double forward_x, forward_z; /* unit: the heading */
    /* Most impulses by which the ground keeps the body at its motion in this frame: along the
     * heading and across it [N s], and about the vertical [N m s]. */
    double grip_along, grip_across, grip_turn;
    struct level_motion wanted; /* the solver's own: moved as it was given */
};

struct level_contact {
    uint32_t a, b;             /* bodies; they differ */
    double normal_x, normal_z; /* unit, from a towards b */
    double a_x, a_z, b_x, b_z; /* [m] from the bodies' centres to the point */
    double least_mps;          /* speed along the normal afterwards, at least; below 0: may close */
    double apart_mps;          /* speed at which an overlap is recovered, > 0; 0: no overlap */
    double friction;           /* Coulomb's coefficient */
    double normal_ns;          /* [N s] impulse along the normal, >= 0; in: where it begins */
    double friction_ns;        /* [N s] impulse across it; in: where it begins */
    double apart_ns, part_mps; /* the solver's own: of the second velocities */
    /* The solver's own: effective masses [kg], levers about the centres [m], and the speeds before
     * the contacts [m/s], along the normal and across it. */
    double normal_kg, across_kg;
    double normal_lever_a, normal_lever_b, across_lever_a, across_lever_b;
    double normal_before_mps, across_before_mps;
};

/* Solves the contacts. Linear and angular momentum change only by the ground's grip. The result
 * depends on the order of the contacts, which must be the caller's fixed one. A contact between two
 * fixed bodies bears nothing. */
void level_solver_run(struct level_lanes *lanes, struct level_body *body, uint32_t bodies,
                      struct level_contact *contact, uint32_t contacts);

/* Recovers the overlaps of the contacts that these lanes have solved last: sets the bodies' pushed.
 */
void level_solver_part(struct level_lanes *lanes, struct level_body *body, uint32_t bodies,
                       struct level_contact *contact, uint32_t contacts);

/* Returns the speed at which the bodies of a contact close at its point [m/s], below 0 if they
 * part. */
double level_solver_closing(const struct level_body *body, const struct level_contact *contact);

#endif
