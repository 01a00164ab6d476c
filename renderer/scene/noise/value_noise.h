/* Value noise: smooth, cheap and the same in every run. It affects pictures only. */
#ifndef JOLON_RENDERER_SCENE_NOISE_VALUE_NOISE_H
#define JOLON_RENDERER_SCENE_NOISE_VALUE_NOISE_H

#include <stdint.h>

/* Returns a hash of a lattice point. */
static inline uint32_t value_noise_hash(int32_t x, int32_t z, uint32_t seed)
{
    uint32_t h = (uint32_t)x * 0x8da6b343u ^ (uint32_t)z * 0xd8163841u ^ seed * 0xcb1ab31fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return h ^ h >> 15;
}

/* Returns a hash of a lattice point as a number in [0, 1). */
static inline float value_noise_unit(int32_t x, int32_t z, uint32_t seed)
{
    return (float)(value_noise_hash(x, z, seed) >> 8) * 0x1.0p-24f;
}

/* Returns floor(v) for a value that fits an int. Computing textures spends most of its time here,
 * so no library function is called. */
static inline int32_t value_noise_floor(double v)
{
    int32_t whole = (int32_t)v;
    return whole - (v < (double)whole);
}

/* Returns smooth noise in -1..1 that varies over about one unit. |x| and |z| must be below 2^31. */
static inline float value_noise_value(double x, double z, uint32_t seed)
{
    int32_t ix = value_noise_floor(x), iz = value_noise_floor(z);
    float u = (float)(x - ix), v = (float)(z - iz);
    u = u * u * (3.0f - 2.0f * u);
    v = v * v * (3.0f - 2.0f * v);
    float a = value_noise_unit(ix, iz, seed), b = value_noise_unit(ix + 1, iz, seed);
    float c = value_noise_unit(ix, iz + 1, seed), d = value_noise_unit(ix + 1, iz + 1, seed);
    float top = a + (b - a) * u, bottom = c + (d - c) * u;
    return 2.0f * (top + (bottom - top) * v) - 1.0f;
}

#endif
