/* Convex hulls of a few points. Joining the pieces of a model makes hundreds of hulls, of which few
 * are kept (config/mesh/hulls.h).
 *
 * Points are snapped to a lattice of half a micrometre, on which the side of a plane that a point
 * is on is computed exactly. So a hull is always closed and convex, even when points are nearly in
 * one plane, and the same to the bit on every machine. Pure; start-up only. */
#ifndef JOLON_CONFIG_MESH_CONVEX_HULL_H
#define JOLON_CONFIG_MESH_CONVEX_HULL_H

#include "world/maths/maths.h"

#include <stdbool.h>
#include <stdint.h>

/* Steps of the lattice in a metre. Coordinates are -CONVEX_HULL_EXTENT_M..CONVEX_HULL_EXTENT_M. */
#define CONVEX_HULL_STEPS    2097152.0
#define CONVEX_HULL_EXTENT_M 1024.0

/* Least thickness of a hull [m]. */
#define CONVEX_HULL_THIN_M 1e-5

/* A hull that has more triangles than this at any time while it grows fails with ERANGE. */
#define CONVEX_HULL_FACES_MAX 4096

/* A triangle of the hull. */
struct convex_hull_face {
    uint32_t corner[3]; /* indices of points, counter-clockwise from outside */
    struct vec3 normal; /* unit, outwards */
    double offset_m;    /* inside is normal . p <= offset_m */
    double area_m2;
};

struct convex_hull {
    struct vec3 *point; /* vertices of the hull, a part of the points given */
    uint32_t point_count;
    struct convex_hull_face *face;
    uint32_t face_count;
    double volume_m3;
    struct vec3 middle; /* of the points */
};

/* Order of points by x, then y, then z, for qsort(). */
int convex_hull_compare(const void *left, const void *right);

/* Finds the directions in which the points (one or more) span no more than least_m: unit vectors at
 * right angles to each other. Returns how many, 0..3. */
int convex_hull_missing(const struct vec3 *point, uint32_t count, double least_m,
                        struct vec3 axis[3]);

/* Makes the hull of points, in any order; a point may be given twice. 0; -1 with errno ENOMEM, EDOM
 * (the points span fewer than three axes by CONVEX_HULL_THIN_M) or ERANGE. */
int convex_hull_points(struct convex_hull *hull, const struct vec3 *point, uint32_t count);
void convex_hull_free(struct convex_hull *hull);

/* The hull around two hulls, and its volume alone. Errors as above. */
int convex_hull_both(struct convex_hull *hull, const struct convex_hull *a,
                     const struct convex_hull *b);
int convex_hull_volume(double *volume_m3, const struct convex_hull *a, const struct convex_hull *b);

/* The volume that a hull would gain with this point [m3]; 0: the point is inside. */
double convex_hull_growth(const struct convex_hull *hull, struct vec3 point);

/* Returns true if no point of inner is outside of outer by more than slack_m. */
bool convex_hull_holds(const struct convex_hull *outer, const struct convex_hull *inner,
                       double slack_m);

#endif
