/* Times of impact of real shapes: convex hulls that move and turn within the frame, by conservative
 * advancement (Mirtich 1996): time goes forward for as long as a plane surely keeps the hulls
 * apart, so that no touch is ever stepped over, at any speed. Pure; any thread. */
#ifndef JOLON_COLLIDER_GEOMETRY_TIME_OF_IMPACT_H
#define JOLON_COLLIDER_GEOMETRY_TIME_OF_IMPACT_H

#include "collider/geometry/analytic_impact.h"
#include "world/entity/hull.h"
#include "world/maths/rotation.h"

#include <stdbool.h>
#include <stdint.h>

/* Hulls this near touch [m]: a skin that keeps a normal well defined. */
#define TOUCH_M 0.001

/* Slower than this is not coming nearer [m a frame]: it is what rounding leaves of two bodies that
 * rest on each other. */
#define NEARING_M 1e-7

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
struct hull_contact {
    double toi;         /* 0..1 */
    struct vec3 point;  /* [m, world] the middle of where they touch; where they part in the middle,
                           the corner of it that comes nearer the fastest */
    struct vec3 normal; /* unit, from a to b */
    double depth_m;     /* how far they overlap along the normal: 0 for a touch */
};

/* First time in [from, 1] at which the bodies are within TOUCH_M of each other while coming nearer:
 * while the points that touch do so along the normal, turning included. from must not be before
 * either path's since. False when they do not touch.
 *
 * The gap there is TOUCH_M to within 1e-9 m, unless they were nearer at from already. Bodies that
 * are, or overlap, touch at from if they are coming nearer, of several hulls the deepest that do.
 * If they are not, they touch once they are well nearer than at from: by half of the gap that they
 * had, or of TOUCH_M, in an overlap by half of TOUCH_M or by 5 % of it. So resting and parting
 * bodies do not touch, and what parts and comes back is seen before it is half a millimetre deeper.
 *
 * Overlapping hulls are pushed apart along the shallowest of their faces' normals, or of the line
 * between their centres; axes across two edges are left out. Where two edges overlap, that is
 * deeper than need be, by as much as the edges' length; but a touch comes before an overlap, and
 * knows its normal.
 *
 * Swapping a and b gives the same bits, and the opposite normal. At most 1,024 distances a pair of
 * hulls: 3 to 7 a touch is usual, 340 was the most in 200,000 pairs of up to 90 m that turn by up
 * to half a turn a frame. Should they run out, hulls that come nearer there touch there, early. */
bool time_of_impact_touch(const struct swept_body *a, const struct swept_body *b, double from,
                          struct hull_contact *touch);

/* Gap between the bodies at a time [m], 0 when they overlap: what time_of_impact_touch follows. */
double time_of_impact_gap(const struct swept_body *a, const struct swept_body *b, double time);

#endif
