/* Sine, cosine, arc tangent and cube root from + - * / alone; see maths.h for why.
 * Polynomials: fdlibm (Sun Microsystems 1993), kernels k_sin.c, k_cos.c and s_atan.c. */
#include "world/maths.h"

#include <stdint.h>
#include <string.h>

/* pi/2 in two parts: the first has 33 bits, so that n * HIGH is exact for |n| < 2^20. */
#define PIO2_HIGH 1.57079632673412561417e+00
#define PIO2_LOW  6.07710050650619224932e-11

static double kernel_sin(double x)
{
    double z = x * x;
    double r = 8.33333333332248946124e-03 +
               z * (-1.98412698298579493134e-04 +
                    z * (2.75573137070700676789e-06 +
                         z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
    return x + z * x * (-1.66666666666666324348e-01 + z * r);
}

static double kernel_cos(double x)
{
    double z = x * x;
    double r =
        z * (4.16666666666666019037e-02 +
             z * (-1.38888888888741095749e-03 +
                  z * (2.48015872894767294178e-05 +
                       z * (-2.75573143513906633035e-07 +
                            z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
    return 1.0 - (0.5 * z - z * r);
}

void maths_sincos(double angle_rad, double *sine, double *cosine)
{
    double turns = angle_rad * (2.0 / PI);
    int64_t quadrant = (int64_t)(turns + (turns < 0.0 ? -0.5 : 0.5)); /* rounds to the nearest */
    double n = (double)quadrant;
    double x = (angle_rad - n * PIO2_HIGH) - n * PIO2_LOW;
    /* By tables, not branches: which quadrant a heading is in no processor can guess. */
    const double kernel[2] = {kernel_sin(x), kernel_cos(x)};
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

/* Coefficients of the arc tangent. */
#define ATAN_0  3.33333333333329318027e-01
#define ATAN_1  (-1.99999999998764832476e-01)
#define ATAN_2  1.42857142725034663711e-01
#define ATAN_3  (-1.11111104054623557880e-01)
#define ATAN_4  9.09088713343650656196e-02
#define ATAN_5  (-7.69187620504482999495e-02)
#define ATAN_6  6.66107313738753120669e-02
#define ATAN_7  (-5.83357013379057348645e-02)
#define ATAN_8  4.97687799461593236017e-02
#define ATAN_9  (-3.65315727442169155270e-02)
#define ATAN_10 1.62858201153657823623e-02

/* Arc tangent for 0 <= x <= 7/16. */
static double kernel_atan(double x)
{
    double z = x * x;
    double w = z * z;
    double even =
        z * (ATAN_0 + w * (ATAN_2 + w * (ATAN_4 + w * (ATAN_6 + w * (ATAN_8 + w * ATAN_10)))));
    double odd = w * (ATAN_1 + w * (ATAN_3 + w * (ATAN_5 + w * (ATAN_7 + w * ATAN_9))));
    return x - x * (even + odd);
}

/* Arc tangent of y / x for 0 <= y <= x, x > 0. */
static double atan_octant(double y, double x)
{
    const double atan_half = 4.63647609000806093515e-01;
    double t = y / x;
    if (t <= 0.4375)
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

typedef double two __attribute__((vector_size(2 * sizeof(double))));

void maths_slopes(const double rise[2], const double run[2], double angle_rad[2])
{
    two t = (two){rise[0], rise[1]} / (two){run[0], run[1]};
    if (!(fabs(t[0]) <= 0.4375 && fabs(t[1]) <= 0.4375)) { /* steeper than vehicles climb */
        angle_rad[0] = maths_atan2(rise[0], run[0]);
        angle_rad[1] = maths_atan2(rise[1], run[1]);
        return;
    }
    /* kernel_atan(), which is odd to the bit. */
    two z = t * t, w = z * z;
    two even =
        z * (ATAN_0 + w * (ATAN_2 + w * (ATAN_4 + w * (ATAN_6 + w * (ATAN_8 + w * ATAN_10)))));
    two odd = w * (ATAN_1 + w * (ATAN_3 + w * (ATAN_5 + w * (ATAN_7 + w * ATAN_9))));
    two angle = t - t * (even + odd);
    angle_rad[0] = angle[0];
    angle_rad[1] = angle[1];
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
