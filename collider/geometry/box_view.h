/* Boxes around the hulls of two bodies: which pairs of hulls may be near each other, by six axes
 * and without looking at a vertex. The box of a turret or a gun holds it in the whole frame,
 * however it turns. Pure; any thread. */
#ifndef JOLON_COLLIDER_GEOMETRY_BOX_VIEW_H
#define JOLON_COLLIDER_GEOMETRY_BOX_VIEW_H

#include "collider/geometry/time_of_impact.h"

#include <stdbool.h>
#include <stdint.h>

/* How two bodies lie to each other. */
struct box_view {
    struct mat3 turn;      /* from b's axes to a's */
    struct vec3 between_a; /* [m] from a's position to b's, in a's axes */
    struct vec3 between_b; /* the same in b's axes */
    double slack_a[3];     /* [m] boxes may be this far apart along a's axes */
    double slack_b[3];
};

/* Returns the view of two bodies with these rotations. between: from a's position to b's [m,
 * world]. Boxes within margin_m [m, >= 0] of each other are near. */
struct box_view box_view_of(const struct mat3 *a, const struct mat3 *b, struct vec3 between,
                            double margin_m);

/* The same for bodies that move: boxes are near if they are so anywhere on the way of b relative to
 * a, which begins at between. */
struct box_view box_view_swept(const struct mat3 *a, const struct mat3 *b, struct vec3 between,
                               struct vec3 way, double margin_m);

/* Returns true if the boxes of two hulls, one of each body, are certainly not near. */
bool box_view_apart(const struct box_view *view, const struct swept_body *a,
                    const struct hull *hull_a, const struct swept_body *b,
                    const struct hull *hull_b);

/* Returns the pairs of hulls of the bodies that may be near: bit HULLS_A_MODEL * i + j for hull i
 * of a and hull j of b. A pair without its bit is certainly not near. */
uint64_t box_view_near(const struct box_view *view, const struct swept_body *a,
                       const struct swept_body *b);

#endif
