/* Free rotation: how a rigid body turns that no torque acts on. Its angular momentum is constant in
 * the world, while its spin changes as the body turns, because its moments of inertia differ.
 *
 * Angular momentum is constant to rounding, and so is kinetic energy: both to 1e-15 a call. The
 * orientation is that of Euler's equations to within 2e-7 rad for each radian turned. Uses only + -
 * * / sqrt, so the result is the same to the bit on every machine. Pure; any thread. */
#ifndef JOLON_WORLD_ENTITY_FREE_ROTATION_H
#define JOLON_WORLD_ENTITY_FREE_ROTATION_H

#include "world/maths/rotation.h"

#include <stdint.h>

/* A free rotation from its beginning on. */
struct free_rotation {
    struct quat from;
    struct vec3 moment;   /* [kg m2] about body axes, > 0 */
    struct vec3 momentum; /* [N m s, world axes] */
    double duration_s;
    uint32_t steps; /* of the whole duration; 0: the body does not turn */
};

/* Returns the free rotation of a body with these moments (mass_properties.h), this orientation and
 * this spin [rad/s, world axes] for a duration >= 0. With equal moments the spin is constant. A
 * body that would turn by more than 64 rad turns by 64 rad. */
struct free_rotation free_rotation_of(struct vec3 moment, struct quat from, struct vec3 spin_rps,
                                      double duration_s);

/* Returns the orientation at a share 0..1 of the duration. It is a smooth function of the share. */
struct quat free_rotation_at(const struct free_rotation *rotation, double share);

/* Returns the angular momentum [N m s, world axes] of a body with this orientation and spin. */
struct vec3 free_rotation_momentum(struct vec3 moment, struct quat turned, struct vec3 spin_rps);

/* Returns the spin [rad/s, world axes] of a body with this orientation and angular momentum. */
struct vec3 free_rotation_spin(struct vec3 moment, struct quat turned, struct vec3 momentum);

/* Returns the greatest angular speed of the rotation [rad/s] or a little more. No point at r from
 * the centre of mass is accelerated by more than *bend times r [1/s2]. */
double free_rotation_rate(const struct free_rotation *rotation, double *bend);

/* Turns a body for dt_s: replaces its orientation and its spin [rad/s, world axes]. */
void free_rotation_turn(struct vec3 moment, struct quat *turned, struct vec3 *spin_rps,
                        double dt_s);

#endif
