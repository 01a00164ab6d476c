/* Euler angles of DIS. */
#include "gateway/earth/euler.h"

/* If the sine of theta is nearer to 1 than this, theta is a right angle. */
#define RIGHT_ANGLE 1e-12

struct mat3 euler_matrix(struct euler angles)
{
    double s1, c1, s2, c2, s3, c3;
    maths_sincos(angles.psi, &s1, &c1);
    maths_sincos(angles.theta, &s2, &c2);
    maths_sincos(angles.phi, &s3, &c3);
    return (struct mat3){{{c1 * c2, c1 * s2 * s3 - s1 * c3, c1 * s2 * c3 + s1 * s3},
                          {s1 * c2, s1 * s2 * s3 + c1 * c3, s1 * s2 * c3 - c1 * s3},
                          {-s2, c2 * s3, c2 * c3}}};
}

struct euler euler_of(const struct mat3 *matrix)
{
    const double(*m)[3] = matrix->m;
    double level = sqrt(m[0][0] * m[0][0] + m[1][0] * m[1][0]);
    struct euler angles = {.theta = maths_atan2(-m[2][0], level)};
    if (1.0 - fabs(m[2][0]) < RIGHT_ANGLE) {
        angles.psi = maths_atan2(-m[0][1], m[1][1]);
        return angles;
    }
    angles.psi = maths_atan2(m[1][0], m[0][0]);
    angles.phi = maths_atan2(m[2][1], m[2][2]);
    return angles;
}

double euler_angle_between(const struct mat3 *a, const struct mat3 *b)
{
    /* The distance of two rotation matrices (Frobenius) is sqrt(8) sin(angle / 2), which is exact
     * for small angles, where the trace is not. */
    double distance2 = 0.0, product = 0.0;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double difference = a->m[i][j] - b->m[i][j];
            distance2 += difference * difference;
            product += a->m[i][j] * b->m[i][j];
        }
    }
    double half_sine = sqrt(distance2 / 8.0),
           half_cosine = sqrt(maths_max(0.0, 1.0 + product) / 4.0);
    return 2.0 * maths_atan2(half_sine, half_cosine);
}
