/* An oracle for tests of hulls that move: each vertex is put where it is at a time, with turret and
 * gun as they point then, by the C library's functions. A failure in here fails the calling cmocka
 * test. */
#ifndef JOLON_TESTS_SUPPORT_PLACED_HULLS_H
#define JOLON_TESTS_SUPPORT_PLACED_HULLS_H

#include "collider/geometry/gjk.h"
#include "collider/geometry/time_of_impact.h"

#define PLACED_HULLS_VERTICES 2048

/* A body's hulls in the world at a time, relative to a point nearby [m]. */
struct placed_hulls {
    struct vec3 vertex[PLACED_HULLS_VERTICES];
    struct convex hull[HULLS_A_MODEL];
    uint32_t hulls;
};

/* Places a body's hulls as they are at a time in [0, 1] of the frame. */
void placed_hulls_put(const struct swept_body *body, double time, struct vec3 near,
                      struct placed_hulls *to);

#endif
