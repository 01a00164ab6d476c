/* Rotations as unit quaternions and matrices. Body axes: x forward, y up, z right; world axes: x
 * east, y up, z south. Only + - * / sqrt and maths_sincos: the same bits everywhere. Pure; any
 * thread. */
#ifndef JOLON_WORLD_ROTATION_H
#define JOLON_WORLD_ROTATION_H

#include "world/maths.h"

struct quat {
    double w, x, y, z; /* unit */
};

/* Row by row: world = turn * body. */
struct mat3 {
    double m[3][3];
};

/* Heading clockwise from north, then pitch nose up, then roll right side down [rad]. */
struct quat rotation_of(double heading_rad, double pitch_rad, double roll_rad);

/* Back: heading 0..2 pi, pitch -pi/2..pi/2, roll -pi..pi; roll is 0 when the nose is straight up
 * or down. */
void rotation_angles(struct quat q, double *heading_rad, double *pitch_rad, double *roll_rad);

struct mat3 rotation_matrix(struct quat q);
struct vec3 rotation_apply(const struct mat3 *turn, struct vec3 body); /* body to world */
struct vec3 rotation_back(const struct mat3 *turn, struct vec3 world); /* world to body */

/* The shorter way from a to b, t in 0..1, by normalised linear interpolation. */
struct quat rotation_between(struct quat a, struct quat b, double t);

/* The fastest turning on that way [rad over the whole of it]: 4 tan(angle / 4); INFINITY-free:
 * at most 4 for half a turn. */
double rotation_rate(struct quat a, struct quat b);

/* q turned by spin (world axes, [rad/s]) for dt seconds: exact for a constant spin. */
struct quat rotation_spun(struct quat q, struct vec3 spin_rps, double dt_s);

#endif
