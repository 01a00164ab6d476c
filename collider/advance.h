/* Times of impact of real shapes: convex hulls that move and turn within the frame, by conservative
 * advancement (Mirtich 1996): time goes forward by the gap over the fastest that it can close, so
 * no touch is ever stepped over, at any speed. Pure; any thread. */
#ifndef JOLON_COLLIDER_ADVANCE_H
#define JOLON_COLLIDER_ADVANCE_H

#include "collider/sweep.h"
#include "world/hull.h"
#include "world/rotation.h"

#include <stdbool.h>
#include <stdint.h>

/* Hulls this near touch [m]: a skin that keeps a normal well defined. */
#define TOUCH_M 0.001

/* One body's hulls and its motion. */
struct swept_body {
    const struct hull *hull; /* [hull_count] */
    uint32_t hull_count;
    const struct vec3 *vertices;     /* the world's; a hull's first_vertex counts in here */
    const struct hull_plane *planes; /* the world's */
    double scale;                    /* of the hulls */
    double bound_m;                  /* scaled: every hull is within it of the position */
    struct path path;                /* of the position */
    struct quat from, to;            /* turned at path.since and at 1 */
};

/* Where and how two bodies touch. */
struct touch {
    double toi;         /* 0..1 */
    struct vec3 point;  /* [m, world] between the two nearest points */
    struct vec3 normal; /* unit, from a to b */
    double depth_m;     /* how far they overlap along the normal: 0 for a touch */
};

/* First time in [from, 1] at which the bodies are within TOUCH_M of each other while coming nearer.
 * The gap there is TOUCH_M to within 1e-9 m unless they were nearer at from already. Bodies that
 * overlap at from touch at from if they are coming nearer along the shallowest way out, and depth_m
 * says how deep. False when they do not touch. */
bool advance_touch(const struct swept_body *a, const struct swept_body *b, double from,
                   struct touch *touch);

/* Gap between the bodies at a time [m], 0 when they overlap: what advance_touch follows. */
double advance_gap(const struct swept_body *a, const struct swept_body *b, double time);

#endif
