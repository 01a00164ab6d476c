/* How far apart two convex hulls are, or how deep they overlap, by separating axes: the normals of
 * both hulls' faces, and the cross products of their edges. It shares no code with the collider's
 * GJK. Pure; any thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_HULL_OVERLAP_H
#define JOLON_SUPERVISOR_PHYSICS_HULL_OVERLAP_H

#include "supervisor/physics/hull_shape.h"
#include "supervisor/physics/rigid_pose.h"

#include <stdbool.h>

/* The place of a second body in the axes of a first one. All sizes of the second are scaled. */
struct relative_place {
    struct vec3 at;                 /* [m] of its position */
    struct vec3 forward, up, right; /* unit */
    double scale;
};

struct relative_place hull_overlap_place(const struct rigid_pose *a, const struct rigid_pose *b,
                                         double scale);

/* Returns the separation of the hulls along an axis of the first body's [m]; below 0 they overlap
 * by so much. */
double hull_overlap_along(const struct hull_shape *a, const struct hull_shape *b,
                          const struct relative_place *place, struct vec3 axis);

/* Returns true if the balls around the hulls, or the normal of a face, show that the hulls are
 * farther apart than enough [m]. *axis is then that normal; its value at the call is tried first.
 */
bool hull_overlap_far(const struct hull_shape *a, const struct hull_shape *b,
                      const struct relative_place *place, double enough, struct vec3 *axis);

/* Returns the greatest separation that an axis shows [m]. If it is below 0 the hulls overlap, and
 * it is less by the depth along the shallowest axis. If it is above 0 the hulls are at least so far
 * apart; the search ends with the first axis that shows more than enough [m]. *axis is the axis of
 * the result, from the first to the second; its value at the call is tried first. */
double hull_overlap_find(const struct hull_shape *a, const struct hull_shape *b,
                         const struct relative_place *place, double enough, struct vec3 *axis);

#endif
