/* Gradient noise: at single points, and along rows that share their lattice points. */
#include "world/maths/noise.h"

#include "world/maths/random.h"

#include <math.h>

/* Scales gradient noise, whose extremes are rare, to about -1..1. */
#define NOISE_GAIN 1.45

struct gradient {
    double x, z;
};

/* Sixteen directions, all equally steep. */
#define SIN_22 0.38268343236508977
#define COS_22 0.92387953251128674
#define COS_45 0.70710678118654752
static const struct gradient directions[16] = {
    {1, 0},  {COS_22, SIN_22},   {COS_45, COS_45},   {SIN_22, COS_22},
    {0, 1},  {-SIN_22, COS_22},  {-COS_45, COS_45},  {-COS_22, SIN_22},
    {-1, 0}, {-COS_22, -SIN_22}, {-COS_45, -COS_45}, {-SIN_22, -COS_22},
    {0, -1}, {SIN_22, -COS_22},  {COS_45, -COS_45},  {COS_22, -SIN_22},
};

static struct gradient gradient_at(uint64_t seed, int64_t column, int64_t row)
{
    uint64_t v = random_mix(seed ^ ((uint64_t)column * 0x9e3779b97f4a7c15u) ^
                            ((uint64_t)row * 0xc2b2ae3d27d4eb4fu));
    return directions[v >> 60];
}

/* Returns the offset of a seed's lattice, so that the noises of two seeds have different zeros. */
static double phase(uint64_t seed, uint64_t axis)
{
    return (double)(random_mix(seed + axis * 0x9e3779b97f4a7c15u) >> 44) * 0x1.0p-12;
}

static double fade(double t)
{
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

static double dot(struct gradient g, double x, double z)
{
    return g.x * x + g.z * z;
}

double noise_at(uint64_t seed, double x, double z)
{
    x += phase(seed, 0);
    z += phase(seed, 1);
    double cx = floor(x), cz = floor(z);
    double fx = x - cx, fz = z - cz, u = fade(fx), v = fade(fz);
    int64_t i = (int64_t)cx, k = (int64_t)cz;
    double nw = dot(gradient_at(seed, i, k), fx, fz);
    double ne = dot(gradient_at(seed, i + 1, k), fx - 1.0, fz);
    double sw = dot(gradient_at(seed, i, k + 1), fx, fz - 1.0);
    double se = dot(gradient_at(seed, i + 1, k + 1), fx - 1.0, fz - 1.0);
    double north = nw + (ne - nw) * u, south = sw + (se - sw) * u;
    return NOISE_GAIN * (north + (south - north) * v);
}

double noise_fractal(uint64_t seed, double x, double z, int octaves)
{
    double sum = 0.0, amplitude = NOISE_FIRST_OCTAVE;
    for (int i = 0; i < octaves; i++) {
        sum += amplitude * noise_at(seed + (uint64_t)i, x, z);
        x *= 2.0;
        z *= 2.0;
        amplitude *= 0.5;
    }
    return sum;
}

/* Between two lattice columns, noise on one row is a blend of two straight lines, one from the
 * gradients at the left, one from those at the right. */
struct edge {
    double level, slope;
};

static struct edge edge_at(uint64_t seed, int64_t column, int64_t row, double fz, double v)
{
    struct gradient north = gradient_at(seed, column, row);
    struct gradient south = gradient_at(seed, column, row + 1);
    return (struct edge){(1.0 - v) * north.z * fz + v * south.z * (fz - 1.0),
                         (1.0 - v) * north.x + v * south.x};
}

void noise_add_row(uint64_t seed, double wavelength_m, double amplitude, struct noise_row row,
                   float *out)
{
    double start = row.x_m / wavelength_m + phase(seed, 0), step = row.step_m / wavelength_m;
    double z = row.z_m / wavelength_m + phase(seed, 1), cz = floor(z), fz = z - cz, v = fade(fz);
    double cell = floor(start), gain = amplitude * NOISE_GAIN;
    int64_t column = (int64_t)cell;
    struct edge left = edge_at(seed, column, (int64_t)cz, fz, v);
    struct edge right = edge_at(seed, column + 1, (int64_t)cz, fz, v);
    for (uint32_t i = 0; i < row.count; i++) {
        double fx = start + (double)i * step - cell;
        while (fx >= 1.0) {
            fx -= 1.0;
            cell += 1.0;
            column++;
            left = right;
            right = edge_at(seed, column + 1, (int64_t)cz, fz, v);
        }
        double a = left.level + left.slope * fx, b = right.level + right.slope * (fx - 1.0);
        out[i] += (float)(gain * (a + (b - a) * fade(fx)));
    }
}

void noise_add_fractal_row(uint64_t seed, double wavelength_m, double amplitude, int octaves,
                           struct noise_row row, float *out)
{
    amplitude *= NOISE_FIRST_OCTAVE;
    for (int i = 0; i < octaves; i++) {
        noise_add_row(seed + (uint64_t)i, wavelength_m, amplitude, row, out);
        wavelength_m *= 0.5;
        amplitude *= 0.5;
    }
}
