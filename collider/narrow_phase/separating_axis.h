/* Proofs that two bodies stay apart: a plane between their outer hulls. A proof costs some hundred
 * cycles, a sweep of two near bodies up to a hundred times as much. Pure; any thread. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_SEPARATING_AXIS_H
#define JOLON_COLLIDER_NARROW_PHASE_SEPARATING_AXIS_H

#include "world/entity/hull.h"
#include "world/maths/rotation.h"

#include <stdbool.h>

struct swept_body;

/* One side of a pair at the beginning and at the end of a time. */
struct axis_side {
    const struct vec3 *vertex; /* of the outer hull, body axes */
    uint32_t count;            /* 0: turret or gun have left their places, and only the box holds */
    double scale;              /* of the vertices */
    struct hull_box box;       /* scaled */
    struct vec3 at[2];         /* [m, world] the position, which moves in a straight line */
    struct mat3 turn[2];       /* how it is turned there */
    /* [m] at most: by how much a point is off the straight line between its two places, because it
     * moves on an arc. */
    double bend_m;
    double turned_m; /* at most: by how much a point of the box is moved by rotation alone */
    bool still;      /* both ends are the same */
};

/* Sets a side to a body from `time` in [path.since, 1] to 1. rate: rotation_rate() from body->from
 * to body->to. The body must not turn freely. */
void axis_side_set(struct axis_side *side, const struct swept_body *body, double rate, double time);

/* Returns true if the outer hulls stay farther apart along the unit axis, which points from a to b,
 * than margin_m, all the time. */
bool separating_axis_holds(const struct axis_side *a, const struct axis_side *b, struct vec3 axis,
                           double margin_m);

/* Finds an axis along which the outer hulls stay farther apart than margin_m [m, >= 0] all the
 * time. Returns false if it finds none: the bodies may touch or not. *axis is tried first, unless
 * it is 0, and becomes the axis found. *apart_m becomes a length by which they stay apart at least,
 * above margin_m. nearest: also searches the nearest points of the outer hulls for an axis, which
 * costs most. */
bool separating_axis_find(const struct axis_side *a, const struct axis_side *b, double margin_m,
                          bool nearest, struct vec3 *axis, double *apart_m);

#endif
