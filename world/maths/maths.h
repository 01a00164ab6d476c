/* Maths whose results do not depend on the C library, the instruction set or the thread count.
 *
 * libm selects its sin, cos and atan2 by the processor (with and without fused multiply-add), and
 * their last bit differs; a digest that must be equal on every machine cannot use them. The
 * functions here use only + - * / sqrt and floor, which IEEE 754 defines to the bit. Pure; any
 * thread. */
#ifndef JOLON_WORLD_MATHS_MATHS_H
#define JOLON_WORLD_MATHS_MATHS_H

#include <math.h>

#define PI      3.14159265358979323846
#define TWO_PI  6.28318530717958647692
#define HALF_PI 1.57079632679489661923

#define DEG_PER_RAD (180.0 / PI)
#define RAD_PER_DEG (PI / 180.0)

union simd_lanes;

struct vec3 {
    double x, y, z;
};

/* Sine and cosine of any finite angle [rad] up to 1e6 in size; error below 2e-16 near zero and
 * 1e-10 at 1e6 (two-constant Cody-Waite reduction; fdlibm's kernel polynomials). */
void maths_sincos(double angle_rad, double *sine, double *cosine);
double maths_sin(double angle_rad);
double maths_cos(double angle_rad);

/* Angle of the vector (x, y) from the x axis, -pi..pi; 0 for (0, 0). Error below 5e-16. */
double maths_atan2(double y, double x);

/* The same for each lane, equal to the bit. */
void maths_sincos_lanes(const union simd_lanes *angle_rad, union simd_lanes *sine,
                        union simd_lanes *cosine);

/* Angles of slopes: maths_atan2(rise, run) of each lane, equal to the bit; run > 0. */
void maths_slopes_lanes(const union simd_lanes *rise, const union simd_lanes *run,
                        union simd_lanes *angle_rad);

/* Cube root of a normal value > 0 (0 for others) by Newton's method on an exponent guess; relative
 * error below 1e-15. */
double maths_cbrt(double value);

/* Return the same angle within [0, 2 pi) and within [-pi, pi). */
double maths_wrap_turn(double angle_rad);
double maths_wrap_half(double angle_rad);

/* Returns the value rounded to a float. gcc 12 leaves the rounding of (double)(float)value out
 * where it makes a vector of two of them, so this goes through memory. */
static inline double maths_as_float(double value)
{
    volatile float rounded = (float)value;
    return (double)rounded;
}

static inline double maths_clamp(double value, double low, double high)
{
    return value < low ? low : value > high ? high : value;
}

/* Returns the share of the way (dx, dz) at which it is nearest to the point (x, z) from its start,
 * 0..1; 0 for a way without length. */
static inline double maths_nearest_share(double x, double z, double dx, double dz)
{
    double square = dx * dx + dz * dz;
    return square > 0.0 ? maths_clamp((x * dx + z * dz) / square, 0.0, 1.0) : 0.0;
}

static inline double maths_min(double a, double b)
{
    return a < b ? a : b;
}
static inline double maths_max(double a, double b)
{
    return a > b ? a : b;
}

static inline struct vec3 vec3_add(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vec3 vec3_sub(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vec3 vec3_scale(struct vec3 a, double s)
{
    return (struct vec3){a.x * s, a.y * s, a.z * s};
}

static inline void vec3_to_floats(float to[3], struct vec3 from)
{
    to[0] = (float)from.x;
    to[1] = (float)from.y;
    to[2] = (float)from.z;
}

static inline double vec3_dot(struct vec3 a, struct vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Right-handed: x cross y is z. */
static inline struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double vec3_length(struct vec3 a)
{
    return sqrt(vec3_dot(a, a));
}

/* Returns v, or a vector of its direction that is `most` long if it is longer; none if its length
 * is no number. */
static inline struct vec3 vec3_limited(struct vec3 v, double most)
{
    double length = vec3_length(v);
    return length <= most ? v : length < INFINITY ? vec3_scale(v, most / length) : (struct vec3){0};
}

/* a + (b - a) * t */
static inline struct vec3 vec3_lerp(struct vec3 a, struct vec3 b, double t)
{
    return vec3_add(a, vec3_scale(vec3_sub(b, a), t));
}

/* Heading [rad, clockwise from north] of a horizontal direction; x east, z south. */
static inline double maths_heading(double dx, double dz)
{
    return maths_wrap_turn(maths_atan2(dx, -dz));
}

#endif
