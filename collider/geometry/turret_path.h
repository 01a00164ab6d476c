/* Where a body's turret and gun point within the frame. The turret turns about the body's up axis
 * through its pivot, the gun about the turret's right axis through a pivot of its own. Both angles
 * change evenly over the frame. Pure; any thread. */
#ifndef JOLON_COLLIDER_GEOMETRY_TURRET_PATH_H
#define JOLON_COLLIDER_GEOMETRY_TURRET_PATH_H

#include "world/entity/hull.h"
#include "world/maths/rotation.h"

#include <stdbool.h>
#include <stdint.h>

/* How a part lies in its body: a point of the part, as the model has it, is at turn * point + at,
 * in body axes [m]. */
struct part_pose {
    struct mat3 turn;
    struct vec3 at;
};

/* How a part moves relative to its body: at and the axes, in body axes. */
struct part_motion {
    struct part_pose pose;
    struct vec3 velocity; /* of at [m a frame] */
    struct vec3 spin;     /* [rad a frame] */
};

struct turret_path {
    const struct hull *outer;                   /* [outers] one hull around each part */
    uint32_t outers;                            /* 0: no part ever leaves its place in the model */
    struct vec3 turret_pivot, gun_pivot;        /* [m] body axes */
    double turret, gun;                         /* [rad] at the frame's beginning */
    double turret_turn, gun_turn;               /* [rad] over the frame */
    struct part_pose turret_begins, gun_begins; /* at the frame's beginning */
};

/* How far the points of a hull move by turret and gun, at most. */
struct part_bounds {
    double reach; /* distance from the body's position [m] */
    double speed; /* relative to the body [m a frame] */
    double bend;  /* acceleration relative to the body [m a frame^2] */
};

/* Sets the path's angles at the frame's beginning and by how much they change. */
void turret_path_set(struct turret_path *path, double turret, double gun, double turret_turn,
                     double gun_turn);

/* Returns true if turret or gun move within the frame. */
static inline bool turret_path_moves(const struct turret_path *path)
{
    return path->turret_turn != 0.0 || path->gun_turn != 0.0;
}

/* Returns true if the hull's place in the body is not that of the model. */
static inline bool turret_path_turns(const struct turret_path *path, const struct hull *hull)
{
    return path->outers > 0 && hull->part != HULL_PART_BODY;
}

/* Return how turret or gun lie and move at a time 0..1. */
struct part_pose turret_path_pose(const struct turret_path *path, uint32_t part, double time);
struct part_motion turret_path_at(const struct turret_path *path, uint32_t part, double time);

/* Returns the bounds of all points within radius_m of the centre of a hull of turret or gun. */
struct part_bounds turret_path_bounds(const struct turret_path *path, const struct hull *hull,
                                      double radius_m);

/* Returns a box around the hull in the whole frame, in body axes. */
struct hull_box turret_path_box(const struct turret_path *path, const struct hull *hull);

/* Returns the same around all hulls of the body, of which a part must have left its place. */
struct hull_box turret_path_box_all(const struct turret_path *path);

/* Orders two paths for a result that does not depend on the order of bodies: -1, 0, 1. */
int turret_path_order(const struct turret_path *a, const struct turret_path *b);

#endif
