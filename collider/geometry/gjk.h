/* Distance between two convex bodies, by the algorithm of Gilbert, Johnson and Keerthi (1988).
 * Pure; any thread; the same bits everywhere. */
#ifndef JOLON_COLLIDER_GEOMETRY_GJK_H
#define JOLON_COLLIDER_GEOMETRY_GJK_H

#include "world/maths/rotation.h"

#include <stdbool.h>
#include <stdint.h>

/* A convex body where it is: the hull of turn * (scale * vertex) + at. */
struct convex {
    const struct vec3 *vertex; /* body axes [m] */
    uint32_t count;            /* >= 1 */
    double scale;              /* > 0 */
    struct mat3 turn;
    struct vec3 at; /* [m]; relative to anything near: 50 km cost no digits that matter */
};

/* Nearer than this is an overlap [m]: below it the normal would be noise. */
#define GJK_OVERLAP_M 1e-10

struct gjk {
    double distance_m;      /* 0 when they overlap */
    struct vec3 on_a, on_b; /* the nearest points; equal to each other when they overlap */
    struct vec3 normal;     /* unit, from a to b; zero when they overlap */
};

/* Error of the distance: below 1e-9 m for bodies up to 100 m, however thin, flat or small. The
 * plane across the normal keeps the bodies as far apart, to 1e-9 m (1e-8 m for bodies nearer than
 * 1e-6 m). Bounded: at most 9 looks of 64 rounds, one look nearly always and a few rounds; should
 * they ever run out, the points are on the bodies and the distance is the least one seen, so too
 * long. */
struct gjk gjk_distance(const struct convex *a, const struct convex *b);

/* Where a search begins, and where it ended: a good beginning for the same bodies a little later.
 */
struct gjk_start {
    struct vec3 guess;          /* of the normal, any length, while count is 0 */
    uint32_t count, a[3], b[3]; /* of nearest vertices of a and of b */
};

/* The same from such a beginning. */
struct gjk gjk_distance_from(const struct convex *a, const struct convex *b,
                             struct gjk_start *start);

/* Where a vertex is relative to at. */
struct vec3 gjk_vertex(const struct convex *convex, uint32_t vertex);

/* The vertex farthest in a direction, the first of several, and where it is relative to at. */
uint32_t gjk_support(const struct convex *convex, struct vec3 direction, struct vec3 *point);

#endif
