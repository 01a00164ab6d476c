/* Rotations as unit quaternions and matrices. Body axes: x forward, y up, z right; world axes: x
 * east, y up, z south. Uses only + - * / sqrt and maths_sincos, so the result is the same to the
 * bit on every machine. Pure; any thread. */
#ifndef JOLON_WORLD_MATHS_ROTATION_H
#define JOLON_WORLD_MATHS_ROTATION_H

#include "world/maths/maths.h"

struct quat {
    double w, x, y, z; /* unit */
};

/* Row by row: world = turn * body. The columns are the body's forward, up and right. */
struct mat3 {
    double m[3][3];
};

/* Heading clockwise from north, then pitch nose up, then roll right side down [rad]. */
struct quat rotation_of(double heading_rad, double pitch_rad, double roll_rad);

/* The inverse: heading 0..2 pi, pitch -pi/2..pi/2, roll -pi..pi; roll is 0 if the nose is straight
 * up or down. rotation_of() of the three is the same rotation to within 1e-14 rad everywhere, also
 * near straight up and down, where heading and roll are ill-conditioned. */
void rotation_angles(struct quat q, double *heading_rad, double *pitch_rad, double *roll_rad);

struct mat3 rotation_matrix(struct quat q);

/* Returns the rotation by b and then, about the world's axes, by a. */
struct quat rotation_product(struct quat a, struct quat b);

/* Returns the rotation back. */
static inline struct quat rotation_inverse(struct quat q)
{
    return (struct quat){q.w, -q.x, -q.y, -q.z};
}

/* Body to world. */
static inline struct vec3 rotation_apply(const struct mat3 *turn, struct vec3 body)
{
    const double(*m)[3] = turn->m;
    return (struct vec3){m[0][0] * body.x + m[0][1] * body.y + m[0][2] * body.z,
                         m[1][0] * body.x + m[1][1] * body.y + m[1][2] * body.z,
                         m[2][0] * body.x + m[2][1] * body.y + m[2][2] * body.z};
}

/* World to body. */
static inline struct vec3 rotation_back(const struct mat3 *turn, struct vec3 world)
{
    const double(*m)[3] = turn->m;
    return (struct vec3){m[0][0] * world.x + m[1][0] * world.y + m[2][0] * world.z,
                         m[0][1] * world.x + m[1][1] * world.y + m[2][1] * world.z,
                         m[0][2] * world.x + m[1][2] * world.y + m[2][2] * world.z};
}

/* Returns the rotation by `first` and then, about the axes before it, by `then`. */
static inline struct mat3 rotation_both(const struct mat3 *then, const struct mat3 *first)
{
    struct mat3 both;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            both.m[i][j] = then->m[i][0] * first->m[0][j] + then->m[i][1] * first->m[1][j] +
                           then->m[i][2] * first->m[2][j];
    }
    return both;
}

/* Returns the rotation at t in 0..1 on the shorter path from a to b, by normalised linear
 * interpolation: about one axis that is fixed in the world and in the body, slightly faster in the
 * middle than at the ends. For half a turn the signs of rotation_of() determine the path. */
struct quat rotation_between(struct quat a, struct quat b, double t);

/* Returns the greatest angular speed on that path [rad for the whole of it]: 4 tan(angle / 4),
 * which is finite, at most 4 for half a turn. No point at r from the axis is accelerated by more
 * than rate^2 r. */
double rotation_rate(struct quat a, struct quat b);

/* Returns the angular velocity on that path at t [rad for the whole of it, world axes]; at most
 * rotation_rate(). */
struct vec3 rotation_speed(struct quat a, struct quat b, double t);

/* Returns q rotated by spin (world axes, [rad/s]) for dt seconds: exact for a constant spin. */
struct quat rotation_spun(struct quat q, struct vec3 spin_rps, double dt_s);

#endif
