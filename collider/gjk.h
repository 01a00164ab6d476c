/* Distance between two convex bodies, by the algorithm of Gilbert, Johnson and Keerthi (1988).
 * Pure; any thread; the same bits everywhere. */
#ifndef JOLON_COLLIDER_GJK_H
#define JOLON_COLLIDER_GJK_H

#include "world/rotation.h"

#include <stdbool.h>
#include <stdint.h>

/* A convex body where it is: the hull of turn * (scale * vertex) + at. */
struct convex {
    const struct vec3 *vertex; /* body axes [m] */
    uint32_t count;            /* >= 1 */
    double scale;
    struct mat3 turn;
    struct vec3 at; /* [m]; relative to anything near: 50 km cost no digits that matter */
};

struct gjk {
    double distance_m;      /* 0 when they overlap */
    struct vec3 on_a, on_b; /* the nearest points; equal to each other when they overlap */
    struct vec3 normal;     /* unit, from a to b; zero when they overlap */
};

/* Error of the distance: below 1e-9 m for bodies up to 100 m. */
struct gjk gjk_distance(const struct convex *a, const struct convex *b);

#endif
