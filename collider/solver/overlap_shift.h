/* What a shift of bodies out of each other changes: a body that is moved while it flies past
 * another takes angular momentum from nowhere. Pure; any thread. */
#ifndef JOLON_COLLIDER_SOLVER_OVERLAP_SHIFT_H
#define JOLON_COLLIDER_SOLVER_OVERLAP_SHIFT_H

#include "collider/solver/contact_solver.h"

#include <stdbool.h>

/* Moves the centres of free bodies by shifts [m, world] that leave their common centre of mass
 * where it is, and changes velocities and spins by the little that conserves linear and angular
 * momentum to rounding. Kinetic energy does not grow. Returns false if that is not possible,
 * because the bodies hardly move relative to each other; they have then not moved. Every inverse
 * mass and inertia is > 0. */
bool overlap_shift_free(struct solver_body *bodies, const struct vec3 *shift, uint32_t count);

/* Gives bodies that were put elsewhere, with other orientations, the momentum and the angular
 * momentum about their common centre of mass that they had before. Kinetic energy does not grow
 * over what it was before. Returns false, with nothing changed, if that is not possible. */
bool overlap_shift_restore(const struct solver_body *before, struct solver_body *bodies,
                           uint32_t count);

#endif
