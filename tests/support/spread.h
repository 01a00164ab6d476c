/* Random positions of bodies: crowded at a point or spread out. Corners and borders of gridsquares
 * and places beyond the world's edge are drawn more often than by chance. */
#ifndef JOLON_TESTS_SUPPORT_SPREAD_H
#define JOLON_TESTS_SUPPORT_SPREAD_H

#include "world/maths/maths.h"

#include <stdint.h>

/* Centre and extent [m]. */
struct spread {
    double x, z, extent;
};

/* Draws a place with an extent of at most widest [m]. random: the state of fixture_random(). */
struct spread spread_draw(uint64_t *random, double widest);
struct vec3 spread_point(const struct spread *spread, uint64_t *random);

#endif
