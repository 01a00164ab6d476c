/* Seeded gradient noise on the plane (Perlin 2002: quintic fade, gradients hashed from the
 * lattice). The same numbers on every machine; pure; any thread. */
#ifndef JOLON_WORLD_MATHS_NOISE_H
#define JOLON_WORLD_MATHS_NOISE_H

#include <stdint.h>

/* Amplitude of the first octave in a fractal sum; each further octave has half of the previous
 * amplitude. */
#define NOISE_FIRST_OCTAVE 0.6

/* Returns noise of about -1..1 with mean 0, one hill or hollow for each unit of x and z; each seed
 * has a lattice of its own. */
double noise_at(uint64_t seed, double x, double z);

/* Returns a sum of octaves, each of twice the frequency and half the amplitude; about -1..1. Octave
 * i uses seed + i. */
double noise_fractal(uint64_t seed, double x, double z, int octaves);

/* Points x_m + i * step_m, z_m for i = 0 .. count - 1, eastwards. */
struct noise_row {
    double x_m, step_m, z_m;
    uint32_t count;
};

/* Adds amplitude * noise_at(seed, x / wavelength_m, z / wavelength_m), and the same of
 * noise_fractal, to out[0 .. count - 1]. A row shares its lattice points, so it costs a fraction
 * of count single calls; it differs from them by rounding only. */
void noise_add_row(uint64_t seed, double wavelength_m, double amplitude, struct noise_row row,
                   float *out);
void noise_add_fractal_row(uint64_t seed, double wavelength_m, double amplitude, int octaves,
                           struct noise_row row, float *out);

#endif
