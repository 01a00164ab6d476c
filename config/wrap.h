/* Wraps: convex hulls of a few points, quickly. Joining the pieces of a model asks for the volumes
 * of hundreds of hulls, most of which nobody keeps (config/hulls.h). Only + - * / and sqrt: the
 * same bits everywhere. Pure; start-up only. */
#ifndef JOLON_CONFIG_WRAP_H
#define JOLON_CONFIG_WRAP_H

#include "world/maths.h"

#include <stdbool.h>
#include <stdint.h>

/* Points this near to the hull of the others count as in it [m]: what float rounds off at 16 m. */
#define WRAP_SLACK_M 1e-6

/* A hull that grows past this many triangles on the way is given up: ERANGE. */
#define WRAP_FACES_MAX 4096

/* A triangle of the hull. */
struct wrap_face {
    uint32_t corner[3]; /* indices of points, counter-clockwise from outside */
    struct vec3 normal; /* unit, outwards; zero when the triangle has no area */
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

/* Order of points by x, then y, then z, for qsort() and bsearch(). */
int wrap_compare(const void *left, const void *right);

/* Directions in which the points (one or more) span no more than least_m: unit, at right angles to
 * each other. Returns how many, 0..3. */
int wrap_missing(const struct vec3 *point, uint32_t count, double least_m, struct vec3 axis[3]);

/* Wraps points, in any order, some of them given twice. 0; -1 with errno ENOMEM; EDOM when they
 * span fewer than three axes by more than WRAP_SLACK_M, or rounding tears the hull; ERANGE. */
int wrap_points(struct wrap *wrap, const struct vec3 *point, uint32_t count);
void wrap_free(struct wrap *wrap);

/* The wrap of two wraps, and its volume alone. Errors as above. */
int wrap_both(struct wrap *wrap, const struct wrap *a, const struct wrap *b);
int wrap_volume(double *volume_m3, const struct wrap *a, const struct wrap *b);

/* How much larger the wrap would be with this point added [m3]; 0 inside. Exact. */
double wrap_growth(const struct wrap *wrap, struct vec3 point);

/* Are all points of inner within outer? */
bool wrap_holds(const struct wrap *outer, const struct wrap *inner);

#endif
