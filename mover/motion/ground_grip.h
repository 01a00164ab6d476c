/* How much the ground holds wheels and tracks, by what it is. Pure; any thread. */
#ifndef JOLON_MOVER_MOTION_GROUND_GRIP_H
#define JOLON_MOVER_MOTION_GROUND_GRIP_H

#include "mover/context/step_context.h"
#include "world/terrain/terrain.h"

struct ground_grip {
    double friction; /* greatest force along the ground over the load */
    double wheels;   /* rolling resistance over the load, of wheels */
    double tracks;   /* the same of tracks */
};

/* Returns the grip of a cover without craters. */
struct ground_grip ground_grip_of(enum cover cover);

/* Returns the grip at a point: of its cover, of a skid pan, of the debris of a fallen object, or of
 * the loose earth in a crater. */
struct ground_grip ground_grip_at(const struct step_context *context, double x, double z);

#endif
