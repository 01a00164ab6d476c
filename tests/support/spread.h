/* Where the bodies of a random world are: heaped on a point or spread out, on the corners and
 * borders of gridsquares and past the world's edge more often than chance would have it. */
#ifndef JOLON_TESTS_SUPPORT_SPREAD_H
#define JOLON_TESTS_SUPPORT_SPREAD_H

#include "world/maths/maths.h"

#include <stdint.h>

/* Its middle and its size [m]. */
struct spread {
    double x, z, extent;
};

/* At most widest [m]; random: a state of fixture_random. */
struct spread spread_draw(uint64_t *random, double widest);
struct vec3 spread_point(const struct spread *spread, uint64_t *random);

#endif
