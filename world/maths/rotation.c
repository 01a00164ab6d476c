/* Quaternions: products are written out, and ratios of lengths replace trigonometry where
 * possible. */
#include "world/maths/rotation.h"

/* If the horizontal part of the nose is a smaller share of its length, the nose points straight up
 * or down. */
#define STRAIGHT 1e-15

struct quat rotation_product(struct quat a, struct quat b)
{
    return (struct quat){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
                         a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                         a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                         a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

static double dot(struct quat a, struct quat b)
{
    return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct quat scaled(struct quat q, double s)
{
    return (struct quat){q.w * s, q.x * s, q.y * s, q.z * s};
}

static struct quat sum(struct quat a, struct quat b)
{
    return (struct quat){a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z};
}

/* Returns b or -b, which is the same rotation: the one nearer to a. */
static struct quat nearer(struct quat a, struct quat b)
{
    return dot(a, b) < 0.0 ? scaled(b, -1.0) : b;
}

struct quat rotation_of(double heading_rad, double pitch_rad, double roll_rad)
{
    /* With the identity the nose points east, so the heading is taken relative to a quarter turn
     * about y. */
    struct quat yaw = {0}, pitch = {0}, roll = {0};
    maths_sincos(0.5 * (HALF_PI - heading_rad), &yaw.y, &yaw.w);
    maths_sincos(0.5 * pitch_rad, &pitch.z, &pitch.w);
    maths_sincos(0.5 * roll_rad, &roll.x, &roll.w);
    return rotation_product(yaw, rotation_product(pitch, roll));
}

void rotation_angles(struct quat q, double *heading_rad, double *pitch_rad, double *roll_rad)
{
    const struct mat3 turn = rotation_matrix(q);
    const double(*m)[3] = turn.m;
    double level = sqrt(m[0][0] * m[0][0] + m[2][0] * m[2][0]); /* horizontal length of the nose */
    *pitch_rad = maths_atan2(m[1][0], level);
    if (level < STRAIGHT) {
        *heading_rad = maths_wrap_turn(maths_atan2(m[2][2], m[0][2])); /* the right side is level */
        *roll_rad = 0.0;
        return;
    }
    /* The horizontal direction across the nose; the angle of up and right from it is the roll. */
    double east = -m[2][0] / level, south = m[0][0] / level;
    *heading_rad = maths_heading(m[0][0], m[2][0]);
    *roll_rad = maths_atan2(east * m[0][1] + south * m[2][1], east * m[0][2] + south * m[2][2]);
}

struct mat3 rotation_matrix(struct quat q)
{
    double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
    double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
    double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    return (struct mat3){{{1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)},
                          {2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wx)},
                          {2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy)}}};
}

struct quat rotation_between(struct quat a, struct quat b, double t)
{
    struct quat q = sum(scaled(a, 1.0 - t), scaled(nearer(a, b), t));
    return scaled(q, 1.0 / sqrt(dot(q, q)));
}

double rotation_rate(struct quat a, struct quat b)
{
    struct quat to = nearer(a, b);
    struct quat apart = sum(to, scaled(a, -1.0)), together = sum(to, a);
    return 4.0 * sqrt(dot(apart, apart) / dot(together, together));
}

struct vec3 rotation_speed(struct quat a, struct quat b, double t)
{
    /* The derivative of q = (1 - t) a + t b is b - a, and the angular velocity 2 (b - a) q* /
     * |q|^2, whose vector part is that of 2 (b - a) a* / |q|^2: always along one axis. */
    struct quat to = nearer(a, b), back = {a.w, -a.x, -a.y, -a.z};
    struct quat q = sum(scaled(a, 1.0 - t), scaled(to, t));
    struct quat way = rotation_product(sum(to, scaled(a, -1.0)), back);
    return vec3_scale((struct vec3){way.x, way.y, way.z}, 2.0 / dot(q, q));
}

struct quat rotation_spun(struct quat q, struct vec3 spin_rps, double dt_s)
{
    double rate = vec3_length(spin_rps), sine, cosine;
    if (rate == 0.0)
        return q;
    maths_sincos(0.5 * rate * dt_s, &sine, &cosine);
    struct vec3 axis = vec3_scale(spin_rps, sine / rate);
    struct quat turned = rotation_product((struct quat){cosine, axis.x, axis.y, axis.z}, q);
    return scaled(turned, 1.0 / sqrt(dot(turned, turned)));
}
