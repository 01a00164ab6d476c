/* How hard aircraft pull up and brake, as far as crews rely on it when they look ahead. Pure. */
#ifndef JOLON_WORLD_ENTITY_CLIMB_LIMITS_H
#define JOLON_WORLD_ENTITY_CLIMB_LIMITS_H

#include "world/entity/kind.h"

#define CLIMB_LIMITS_PULL 1.5 /* [g] over level flight: no aeroplane pulls up harder */

/* Returns the lift that an aeroplane has at a speed [share of its weight]. */
double climb_limits_lift(const struct kind *kind, double speed_mps);

/* Returns the acceleration by which an aircraft changes its climb at a speed [m/s2]. */
double climb_limits_pull(const struct kind *kind, double speed_mps);

/* Returns that by which it slows down [m/s2]. */
double climb_limits_brake(const struct kind *kind);

#endif
