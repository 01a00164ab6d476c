/* How steep the ground about a vehicle is: the tangents of slopes, without craters and works.
 *
 * Reads row i of the moved table and what is known of the ground near it. Any thread. */
#ifndef JOLON_MOVER_CONTEXT_STEEP_GROUND_H
#define JOLON_MOVER_CONTEXT_STEEP_GROUND_H

#include "mover/context/step_context.h"

/* Returns how steep the ground is at a place near row i. */
double steep_ground_at(const struct step_context *context, uint32_t i, double x, double z);

/* Returns how steep the ground is at the steepest of some places on the straight way from row i to
 * a place that is so far to the east and to the south of it [m]. */
double steep_ground_on_way(const struct step_context *context, uint32_t i, double east_m,
                           double south_m);

/* Returns true only if the ground from row i to a place is dry, without craters and no steeper than
 * this. */
bool steep_ground_is_easy(const struct step_context *context, uint32_t i, double x, double z,
                          double most);

#endif
