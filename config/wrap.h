/* Wraps: convex hulls of a few points. Joining the pieces of a model asks for hundreds of hulls,
 * most of which nobody keeps (config/hulls.h).
 *
 * Points are put on a lattice of half a micrometre, on which the side of a plane that a point lies
 * on is found exactly. So a hull is always closed and convex, however flat points lie with each
 * other, and the same to the bit everywhere. Pure; start-up only. */
#ifndef JOLON_CONFIG_WRAP_H
#define JOLON_CONFIG_WRAP_H

#include "world/maths.h"

#include <stdbool.h>
#include <stdint.h>

/* Steps of the lattice in a metre; coordinates are within WRAP_EXTENT_M of 0. */
#define WRAP_STEPS    2097152.0
#define WRAP_EXTENT_M 1024.0

/* Least thickness of what is wrapped [m]. */
#define WRAP_THIN_M 1e-5

/* A hull that grows past this many triangles on the way is given up: ERANGE. */
#define WRAP_FACES_MAX 4096

/* A triangle of the hull. */
struct wrap_face {
    uint32_t corner[3]; /* indices of points, counter-clockwise from outside */
    struct vec3 normal; /* unit, outwards */
    double offset_m;    /* inside is normal . p <= offset_m */
    double area_m2;
};

struct wrap {
    struct vec3 *point; /* the hull's own, at most as many as were given */
    uint32_t point_count;
    struct wrap_face *face;
    uint32_t face_count;
    double volume_m3;
    struct vec3 middle; /* of the points */
};

/* Order of points by x, then y, then z, for qsort(). */
int wrap_compare(const void *left, const void *right);

/* Directions in which the points (one or more) span no more than least_m: unit, at right angles to
 * each other. Returns how many, 0..3. */
int wrap_missing(const struct vec3 *point, uint32_t count, double least_m, struct vec3 axis[3]);

/* Wraps points, in any order, some of them given twice. 0; -1 with errno ENOMEM; EDOM when they
 * span fewer than three axes by WRAP_THIN_M; ERANGE. */
int wrap_points(struct wrap *wrap, const struct vec3 *point, uint32_t count);
void wrap_free(struct wrap *wrap);

/* The wrap of two wraps, and its volume alone. Errors as above. */
int wrap_both(struct wrap *wrap, const struct wrap *a, const struct wrap *b);
int wrap_volume(double *volume_m3, const struct wrap *a, const struct wrap *b);

/* How much larger the wrap would be with this point added [m3]; 0 inside. */
double wrap_growth(const struct wrap *wrap, struct vec3 point);

/* Are all points of inner within slack_m of outer? */
bool wrap_holds(const struct wrap *outer, const struct wrap *inner, double slack_m);

#endif
