/* Drag of the air on wrecks. A wreck is a blunt body: its drag is 1/2 rho v^2 times its drag area,
 * which depends on the side that it turns to the wind. Where it turns, v is the speed of its sides.
 * Pure; any thread. */
#ifndef JOLON_WORLD_ENTITY_WRECK_DRAG_H
#define JOLON_WORLD_ENTITY_WRECK_DRAG_H

#include "world/entity/kind.h"
#include "world/maths/rotation.h"

/* Returns what air at sea level leaves of a wreck's velocity after dt_s: the solution of
 * dv/dt = -k v^2, so that the velocity keeps its direction and never grows, however long the frame.
 * turn is the wreck's pose (world = turn * body), velocity that of its centre of mass [m/s]. */
struct vec3 wreck_drag_slow(const struct kind *kind, const struct mat3 *turn, struct vec3 velocity,
                            double dt_s);

/* Returns what air at sea level leaves of a wreck's spin [rad/s, world axes] after dt_s: for each
 * axis of the body the solution of dw/dt = -k w^2, so that the energy of rotation never grows. */
struct vec3 wreck_drag_slow_spin(const struct kind *kind, const struct mat3 *turn, struct vec3 spin,
                                 double dt_s);

#endif
