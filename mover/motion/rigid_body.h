/* A rigid body that moves freely: its state, its energy, and its motion between contacts. Pure; any
 * thread. */
#ifndef JOLON_MOVER_MOTION_RIGID_BODY_H
#define JOLON_MOVER_MOTION_RIGID_BODY_H

#include "mover/context/step_context.h"
#include "world/entity/mass_properties.h"

struct rigid_body {
    struct mass_properties inertia;
    struct vec3 centre;   /* [m] of mass */
    struct quat turn;     /* from body axes to world axes */
    struct vec3 velocity; /* [m/s] of the centre */
    struct vec3 spin;     /* [rad/s, world axes] */
};

/* Returns row i of the moved table as a body. */
struct rigid_body rigid_body_take(const struct step_context *context, uint32_t i);

/* Writes the body's position, pose, velocity and spin to row i. At the edge of the world the
 * position and the speed across the edge stop. */
void rigid_body_put(const struct step_context *context, uint32_t i, const struct rigid_body *body);

/* Returns the kinetic energy and the potential energy over y = 0 [J]. */
double rigid_body_energy(const struct rigid_body *body);

/* Turns the body for dt_s as a free body. extra_rps is added to the spin while it turns and does
 * not become its own. Angular momentum is conserved to the second order in the angle. The energy of
 * the rotation does not grow. */
void rigid_body_turn(struct rigid_body *body, struct vec3 extra_rps, double dt_s);

/* Slows all motion in the same proportion until the energy is at most most_j [J]. Returns false if
 * the potential energy alone is more: the body then stands still. */
bool rigid_body_limit_energy(struct rigid_body *body, double most_j);

#endif
