/* Distance between two convex bodies, by the algorithm of Gilbert, Johnson and Keerthi (1988).
 * Pure; any thread; the result is the same to the bit on every machine. */
#ifndef JOLON_COLLIDER_GEOMETRY_GJK_H
#define JOLON_COLLIDER_GEOMETRY_GJK_H

#include "world/maths/rotation.h"

#include <stdbool.h>
#include <stdint.h>

/* A convex body in place: the hull of turn * (scale * vertex) + at. */
struct convex {
    const struct vec3 *vertex; /* body axes [m] */
    uint32_t count;            /* >= 1 */
    double scale;              /* > 0 */
    struct mat3 turn;
    struct vec3 at; /* [m]; relative to a point nearby, since coordinates of 50 km cost digits */
};

/* Bodies nearer than this overlap [m]: below it the normal would be noise. */
#define GJK_OVERLAP_M 1e-10

struct gjk {
    double distance_m;      /* 0 when they overlap */
    struct vec3 on_a, on_b; /* the nearest points; equal if the bodies overlap */
    struct vec3 normal;     /* unit, from a to b; zero if the bodies overlap */
    struct vec3 corner[4];  /* from a vertex of b to one of a: where the search ended */
    uint32_t corners;       /* at least 1 */
};

/* The error of the distance is below 1e-9 m for bodies up to 100 m, however thin, flat or small.
 * The plane across the normal separates the bodies by the distance to within 1e-9 m (1e-8 m for
 * bodies nearer than 1e-6 m). Bounded: at most 9 searches of 64 rounds; nearly always one search of
 * a few rounds. If they do not suffice, the points are on the bodies and the distance is the least
 * one found, which is too long. */
struct gjk gjk_distance(const struct convex *a, const struct convex *b);

/* The simplex at which a search begins or ended. The end for one position is a good beginning for a
 * position a little later. */
struct gjk_start {
    struct vec3 guess;          /* of the normal, any length; used while count is 0 */
    uint32_t count, a[3], b[3]; /* of nearest vertices of a and of b */
};

/* The same, beginning at start and leaving the end there. */
struct gjk gjk_distance_from(const struct convex *a, const struct convex *b,
                             struct gjk_start *start);

/* The same for bodies whose distance is not above limit_m. Of bodies that are farther apart it says
 * only that: the search ends with the first plane that proves it, mostly after one or two rounds.
 * distance_m is then a lower bound above limit_m, and on_a, on_b and the end in start are those
 * found so far. */
struct gjk gjk_distance_within(const struct convex *a, const struct convex *b, double limit_m,
                               struct gjk_start *start);

/* Returns a bound that the separation of the bodies along a unit normal is not above, to within
 * 1e-9 m. The corners of bodies that overlap lie around the origin, so that it is good for them. */
double gjk_most_apart(const struct gjk *gjk, struct vec3 normal);

/* Returns the position of a vertex relative to at. */
struct vec3 gjk_vertex(const struct convex *convex, uint32_t vertex);

/* Returns the vertex farthest in a direction, the first of equal ones, and its position relative to
 * at. */
uint32_t gjk_support(const struct convex *convex, struct vec3 direction, struct vec3 *point);

#endif
