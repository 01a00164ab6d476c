/* Convex hulls of a few points. Joining the pieces of a model makes hundreds of hulls, of which few
 * are kept (config/hulls.h).
 *
 * Points are snapped to a lattice of half a micrometre, on which the side of a plane that a point
 * is on is computed exactly. So a hull is always closed and convex, even when points are nearly in
 * one plane, and the same to the bit on every machine. Pure; start-up only. */
#ifndef JOLON_CONFIG_WRAP_H
#define JOLON_CONFIG_WRAP_H

#include "world/maths.h"

#include <stdbool.h>
#include <stdint.h>

/* Steps of the lattice in a metre. Coordinates are -WRAP_EXTENT_M..WRAP_EXTENT_M. */
#define WRAP_STEPS    2097152.0
#define WRAP_EXTENT_M 1024.0

/* Least thickness of a hull [m]. */
#define WRAP_THIN_M 1e-5

/* A hull that has more triangles than this at any time while it grows fails with ERANGE. */
#define WRAP_FACES_MAX 4096

/* A triangle of the hull. */
struct wrap_face {
    uint32_t corner[3]; /* indices of points, counter-clockwise from outside */
    struct vec3 normal; /* unit, outwards */
    double offset_m;    /* inside is normal . p <= offset_m */
    double area_m2;
};

struct wrap {
    struct vec3 *point; /* vertices of the hull, a part of the points given */
    uint32_t point_count;
    struct wrap_face *face;
    uint32_t face_count;
    double volume_m3;
    struct vec3 middle; /* of the points */
};

/* Order of points by x, then y, then z, for qsort(). */
int wrap_compare(const void *left, const void *right);

/* Finds the directions in which the points (one or more) span no more than least_m: unit vectors at
 * right angles to each other. Returns how many, 0..3. */
int wrap_missing(const struct vec3 *point, uint32_t count, double least_m, struct vec3 axis[3]);

/* Makes the hull of points, in any order; a point may be given twice. 0; -1 with errno ENOMEM, EDOM
 * (the points span fewer than three axes by WRAP_THIN_M) or ERANGE. */
int wrap_points(struct wrap *wrap, const struct vec3 *point, uint32_t count);
void wrap_free(struct wrap *wrap);

/* The hull around two hulls, and its volume alone. Errors as above. */
int wrap_both(struct wrap *wrap, const struct wrap *a, const struct wrap *b);
int wrap_volume(double *volume_m3, const struct wrap *a, const struct wrap *b);

/* The volume that a hull would gain with this point [m3]; 0: the point is inside. */
double wrap_growth(const struct wrap *wrap, struct vec3 point);

/* Returns true if no point of inner is outside of outer by more than slack_m. */
bool wrap_holds(const struct wrap *outer, const struct wrap *inner, double slack_m);

#endif
