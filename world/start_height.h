/* The height at which an aeroplane begins. Pure; any thread. */
#ifndef JOLON_WORLD_START_HEIGHT_H
#define JOLON_WORLD_START_HEIGHT_H

#include "world/terrain/terrain.h"

struct kind;

/* Where an aeroplane begins, and how fast it flies. */
struct start_flight {
    double x, z;        /* [m, world] */
    double heading_rad; /* clockwise from north */
    double speed_mps;
    double altitude_m; /* over the ground, as it is told */
};

/* Returns the height over the ground [m] from which an aeroplane that sets out at once can climb
 * over what is ahead of it: altitude_m, or more where the ground rises too steeply for that.
 * Craters and fixed objects do not count. */
double start_height(const struct terrain *terrain, const struct kind *kind,
                    const struct start_flight *flight);

#endif
