/* Orientations of DIS: psi, theta, phi [rad] turn the ECEF axes about z, then about the new y, then
 * about the new x, into the body axes x forward, y right, z down. The matrix is world = M * body.
 * Pure; any thread. */
#ifndef JOLON_GATEWAY_EARTH_EULER_H
#define JOLON_GATEWAY_EARTH_EULER_H

#include "world/maths/rotation.h"

struct euler {
    double psi, theta, phi; /* [rad] -pi..pi, -pi/2..pi/2, -pi..pi */
};

struct mat3 euler_matrix(struct euler angles);

/* The inverse. Where theta is a right angle psi and phi turn about one axis; phi is then 0. */
struct euler euler_of(const struct mat3 *matrix);

/* Returns the angle between two orientations [rad], 0..pi. */
double euler_angle_between(const struct mat3 *a, const struct mat3 *b);

#endif
