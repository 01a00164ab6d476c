/* Where land vehicles cross water. Pure; any thread. */
#ifndef JOLON_MOVER_MOTION_FORDING_H
#define JOLON_MOVER_MOTION_FORDING_H

#include "mover/context/step_context.h"

/* Returns true if there is water at the point. */
bool fording_is_water(const struct step_context *context, double x, double z);

/* Returns true if the point is in the world, and dry or so shallow that the kind fords there. */
bool fording_passable(const struct step_context *context, const struct kind *kind, double x,
                      double z);

#endif
