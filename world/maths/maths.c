/* Sine, cosine, arc tangent and cube root from + - * / alone; see maths.h for why.
 * Polynomials: fdlibm (Sun Microsystems 1993), kernels k_sin.c, k_cos.c and s_atan.c. */
#include "world/maths/maths.h"

#include "world/maths/cpu_dispatch.h"
#include "world/maths/simd.h"

#include <stdint.h>
#include <string.h>

/* pi/2 in two parts: the first has 33 bits, so that n * HIGH is exact for |n| < 2^20. */
#define PIO2_HIGH 1.57079632673412561417e+00
#define PIO2_LOW  6.07710050650619224932e-11

/* Kernels, for a number and for four: the same operations in the same order. */

/* Sine and cosine for |x| <= pi/4. */
#define KERNEL_SINCOS(type, name)                                                                  \
    static inline void name(const type *x, type *sine, type *cosine)                               \
    {                                                                                              \
        type z = *x * *x;                                                                          \
        type r = 8.33333333332248946124e-03 +                                                      \
                 z * (-1.98412698298579493134e-04 +                                                \
                      z * (2.75573137070700676789e-06 +                                            \
                           z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));   \
        *sine = *x + z * *x * (-1.66666666666666324348e-01 + z * r);                               \
        r = z * (4.16666666666666019037e-02 +                                                      \
                 z * (-1.38888888888741095749e-03 +                                                \
                      z * (2.48015872894767294178e-05 +                                            \
                           z * (-2.75573143513906633035e-07 +                                      \
                                z * (2.08757232129817482790e-09 +                                  \
                                     z * -1.13596475577881948265e-11)))));                         \
        *cosine = 1.0 - (0.5 * z - z * r);                                                         \
    }

/* Arc tangent for 0 <= x <= 7/16; odd to the bit, so for those below 0 as well. */
#define KERNEL_ATAN(type, name)                                                                    \
    static inline void name(const type *x, type *angle)                                            \
    {                                                                                              \
        type z = *x * *x;                                                                          \
        type w = z * z;                                                                            \
        type even = z * (ATAN_0 +                                                                  \
                         w * (ATAN_2 + w * (ATAN_4 + w * (ATAN_6 + w * (ATAN_8 + w * ATAN_10))))); \
        type odd = w * (ATAN_1 + w * (ATAN_3 + w * (ATAN_5 + w * (ATAN_7 + w * ATAN_9))));         \
        *angle = *x - *x * (even + odd);                                                           \
    }

#define ATAN_LIMIT 0.4375
#define ATAN_0     3.33333333333329318027e-01
#define ATAN_1     (-1.99999999998764832476e-01)
#define ATAN_2     1.42857142725034663711e-01
#define ATAN_3     (-1.11111104054623557880e-01)
#define ATAN_4     9.09088713343650656196e-02
#define ATAN_5     (-7.69187620504482999495e-02)
#define ATAN_6     6.66107313738753120669e-02
#define ATAN_7     (-5.83357013379057348645e-02)
#define ATAN_8     4.97687799461593236017e-02
#define ATAN_9     (-3.65315727442169155270e-02)
#define ATAN_10    1.62858201153657823623e-02

KERNEL_SINCOS(double, kernel_sincos)
KERNEL_SINCOS(f64x4, kernel_sincos_four)
KERNEL_ATAN(double, kernel_atan_of)
KERNEL_ATAN(f64x4, kernel_atan_four)

static double kernel_atan(double x)
{
    double angle;
    kernel_atan_of(&x, &angle);
    return angle;
}

void maths_sincos(double angle_rad, double *sine, double *cosine)
{
    double turns = angle_rad * (2.0 / PI);
    int64_t quadrant = (int64_t)(turns + (turns < 0.0 ? -0.5 : 0.5)); /* rounds to the nearest */
    double n = (double)quadrant;
    double x = (angle_rad - n * PIO2_HIGH) - n * PIO2_LOW;
    /* By tables instead of branches, since the quadrant of a heading cannot be predicted. */
    double kernel[2];
    kernel_sincos(&x, &kernel[0], &kernel[1]);
    static const double sign[4] = {1.0, 1.0, -1.0, -1.0};
    *sine = kernel[quadrant & 1] * sign[quadrant & 3];
    *cosine = kernel[~quadrant & 1] * sign[(quadrant + 1) & 3];
}

double maths_sin(double angle_rad)
{
    double sine, cosine;
    maths_sincos(angle_rad, &sine, &cosine);
    return sine;
}

double maths_cos(double angle_rad)
{
    double sine, cosine;
    maths_sincos(angle_rad, &sine, &cosine);
    return cosine;
}

/* Arc tangent of y / x for 0 <= y <= x, x > 0. */
static double atan_octant(double y, double x)
{
    const double atan_half = 4.63647609000806093515e-01;
    double t = y / x;
    if (t <= ATAN_LIMIT)
        return kernel_atan(t);
    if (t < 0.6875) /* atan(1/2) + atan((2t - 1) / (2 + t)) */
        return t >= 0.5 ? atan_half + kernel_atan((2.0 * t - 1.0) / (2.0 + t))
                        : atan_half - kernel_atan((1.0 - 2.0 * t) / (2.0 + t));
    return PI / 4.0 - kernel_atan((1.0 - t) / (1.0 + t));
}

double maths_atan2(double y, double x)
{
    double ax = fabs(x);
    double ay = fabs(y);
    double angle;
    if (ax == 0.0 && ay == 0.0)
        return 0.0;
    angle = ay <= ax ? atan_octant(ay, ax) : HALF_PI - atan_octant(ax, ay);
    if (x < 0.0)
        angle = PI - angle;
    static const double sign[2] = {1.0, -1.0};
    return angle * sign[y < 0.0];
}

VECTOR_CLONES
void maths_sincos_lanes(const union simd_lanes *angle_rad, union simd_lanes *sine,
                        union simd_lanes *cosine)
{
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 angle = angle_rad->f64x4[h];
        f64x4 turns = angle * (2.0 / PI);
        f64x4 half = SIMD_CHOOSE(turns < 0.0, SIMD_EVERY(-0.5), SIMD_EVERY(0.5));
        four_cells quadrant = __builtin_convertvector(turns + half, four_cells);
        f64x4 n = __builtin_convertvector(quadrant, f64x4);
        f64x4 x = (angle - n * PIO2_HIGH) - n * PIO2_LOW, s, c;
        kernel_sincos_four(&x, &s, &c);
        four_masks q = __builtin_convertvector(quadrant, four_masks);
        four_masks odd = -(q & 1);
        sine->f64x4[h] = (f64x4)((four_masks)SIMD_CHOOSE(odd, c, s) ^ (q & 2) << 62);
        cosine->f64x4[h] = (f64x4)((four_masks)SIMD_CHOOSE(odd, s, c) ^ ((q + 1) & 2) << 62);
    }
}

VECTOR_CLONES
void maths_slopes_lanes(const union simd_lanes *rise, const union simd_lanes *run,
                        union simd_lanes *angle_rad)
{
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 slope = rise->f64x4[h] / run->f64x4[h];
        kernel_atan_four(&slope, &angle_rad->f64x4[h]);
        four_masks gentle = SIMD_ABS(slope) <= ATAN_LIMIT;
        for (int i = 0; SIMD_ANY(~gentle) && i < 4; i++) {
            if (!gentle[i]) /* steeper than vehicles climb */
                angle_rad->f64x4[h][i] = maths_atan2(rise->f64x4[h][i], run->f64x4[h][i]);
        }
    }
}

double maths_cbrt(double value)
{
    uint64_t bits;
    double guess;
    if (!(value > 0.0))
        return 0.0;
    memcpy(&bits, &value, sizeof bits);
    bits = bits / 3 + 0x2a9f7893782da1ceu; /* a third of the exponent: within 6 % */
    memcpy(&guess, &bits, sizeof guess);
    for (int i = 0; i < 4; i++)
        guess = (2.0 * guess + value / (guess * guess)) * (1.0 / 3.0);
    return guess;
}

double maths_wrap_turn(double angle_rad)
{
    if (angle_rad >= 0.0 && angle_rad < TWO_PI)
        return angle_rad;
    double wrapped = angle_rad - TWO_PI * floor(angle_rad / TWO_PI);
    return wrapped >= TWO_PI || wrapped < 0.0 ? 0.0 : wrapped;
}

double maths_wrap_half(double angle_rad)
{
    double wrapped = maths_wrap_turn(angle_rad);
    return wrapped >= PI ? wrapped - TWO_PI : wrapped;
}
