/* Positions and rotations as the physics check computes them: from docs/scenario.md, and without
 * the code of mover and collider. Pure; any thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_RIGID_POSE_H
#define JOLON_SUPERVISOR_PHYSICS_RIGID_POSE_H

#include "world/maths/maths.h"

/* A body's place. World axes: x east, y up, z south. Body axes: forward, up, right. */
struct rigid_pose {
    struct vec3 at;                 /* [m, world] */
    struct vec3 forward, up, right; /* unit, world axes */
};

/* heading: clockwise from north. pitch: nose up. roll: right side down [rad]. */
struct rigid_pose rigid_pose_of(struct vec3 at, double heading, double pitch, double roll);

/* Return the pose of a part that is turned to the right about its up axis, or raised about its
 * right axis, through a pivot in its own axes [m]. */
struct rigid_pose rigid_pose_turned(const struct rigid_pose *pose, struct vec3 pivot,
                                    double right_rad);
struct rigid_pose rigid_pose_raised(const struct rigid_pose *pose, struct vec3 pivot,
                                    double up_rad);

/* Return a direction of the body in world axes, and a direction of the world in body axes. */
static inline struct vec3 rigid_pose_out(const struct rigid_pose *pose, struct vec3 body)
{
    return vec3_add(vec3_scale(pose->forward, body.x),
                    vec3_add(vec3_scale(pose->up, body.y), vec3_scale(pose->right, body.z)));
}
static inline struct vec3 rigid_pose_in(const struct rigid_pose *pose, struct vec3 world)
{
    return (struct vec3){vec3_dot(pose->forward, world), vec3_dot(pose->up, world),
                         vec3_dot(pose->right, world)};
}

/* Returns the angle of the rotation from one pose to another, 0..pi [rad]. */
double rigid_pose_angle(const struct rigid_pose *from, const struct rigid_pose *to);

#endif
