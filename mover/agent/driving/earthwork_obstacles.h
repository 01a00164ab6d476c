/* Earthworks that a land vehicle cannot cross: trenches that are wider than its kind's trench_m,
 * faces that are steeper than its max_slope_rad and higher than its step_m, and fords that are
 * deeper than its ford_m; and the faces of those that it can. Pure; any thread. */
#ifndef JOLON_MOVER_AGENT_DRIVING_EARTHWORK_OBSTACLES_H
#define JOLON_MOVER_AGENT_DRIVING_EARTHWORK_OBSTACLES_H

#include "world/entity/kind.h"
#include "world/terrain/earthwork.h"

/* A way straight on. */
struct earthwork_way {
    double x, z;     /* [m] its start */
    double ux, uz;   /* its direction, unit */
    double length_m; /* at least 0 */
    double beside_m; /* room that the vehicle needs to each side of its middle */
    double ahead_m;  /* the same in front of its middle */
};

/* Returns how far the way is free of works that the kind cannot cross, 0..length_m. A work that the
 * way starts in does not count: the vehicle has to get out of it. */
double earthwork_obstacles_free(const struct earthworks *works, const struct kind *kind,
                                const struct earthwork_way *way);

/* Takes a face of a work across the way: how far the vehicle's nose is from it, 0 as long as a part
 * of the vehicle is on it [m], and how steeply it rises, as a tangent. */
typedef void earthwork_face(void *context, double far_m, double slope);

/* Calls a function for each face across the way of a work that the kind can cross, up or down, in
 * no order and some of them twice. Trenches that it spans have none, and neither have washboards.
 */
void earthwork_obstacles_faces(const struct earthworks *works, const struct kind *kind,
                               const struct earthwork_way *way, earthwork_face *face,
                               void *context);

#endif
