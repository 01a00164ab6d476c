/* The sweeps of the level solver, over four points at a time. Points that share a body are swept
 * one after the other, in the caller's order. Points that share none are independent: four of them,
 * or fewer, make a four, and each of its lanes is computed as if it were alone. So the result is to
 * the bit that of sweeps over single points in the caller's order. The solver's own; pure; one
 * thread for one level_lanes. */
#ifndef JOLON_COLLIDER_SOLVER_LEVEL_LANES_H
#define JOLON_COLLIDER_SOLVER_LEVEL_LANES_H

#include "world/maths/simd.h"

#include <stdbool.h>
#include <stdint.h>

struct level_contact;

/* Points that share no body, a lane each. What only friction needs comes last. A lane without a
 * point has the number of bodies in a and b, and 0 in all the others. */
struct level_four {
    uint32_t a[4], b[4];
    f64x4 normal_x, normal_z, normal_lever_a, normal_lever_b, normal_kg;
    f64x4 inverse_moment_a, inverse_moment_b;
    f64x4 least_mps, normal_ns;
    f64x4 across_lever_a, across_lever_b, across_kg;
    f64x4 friction, friction_ns;
};

/* Four bodies that the ground holds, a lane each; see struct level_body. */
struct level_held {
    f64x4 forward_x, forward_z, inverse_mass, inverse_moment;
    f64x4 grip_along, grip_across, grip_turn;
    f64x4 wanted_x, wanted_z, wanted_spin;
    f64x4 along, across, turn; /* impulses of the ground so far */
};

struct level_lanes {
    uint64_t body_capacity, point_capacity;
    uint32_t bodies, fours;
    f64x4 *motion; /* [bodies + 1] x, z and spin of each body, and its inverse mass; the last: of
                      none */
    struct level_held *held; /* [bodies / 4, rounded up] */
    struct level_four *four; /* in the order of a sweep */
    uint32_t *place;         /* [points] the point's four times 4, and its lane */
    uint32_t *depth;         /* [bodies] of points that are swept one after the other */
    uint32_t *next;          /* [depths] the next place among the fours of a depth */
};

/* Returns 0, or -1 with errno ENOMEM. More bodies and points than these make the arrays grow. */
int level_lanes_init(struct level_lanes *lanes, uint64_t bodies, uint64_t points);
void level_lanes_free(struct level_lanes *lanes);

/* Gives each point its place. The caller then sets the lanes, motion and held. */
void level_lanes_arrange(struct level_lanes *lanes, uint32_t bodies,
                         const struct level_contact *contact, uint32_t contacts);

/* Gives the bodies the impulses with which the points begin, the friction of each within its cone.
 * Returns true if there is one. */
bool level_lanes_begin(struct level_lanes *lanes);

/* The ground's grip brings the bodies back to the motion that their mover gave them. */
void level_lanes_hold(struct level_lanes *lanes);

/* Sweeps over all points, with and without friction. Return by how much the speed at a point
 * changes at most [m/s]. Most points bear no load, and change nothing. */
double level_lanes_sweep(struct level_lanes *lanes, bool backwards);
double level_lanes_sweep_smooth(struct level_lanes *lanes, bool backwards);

#endif
