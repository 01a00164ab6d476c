/* Vectors of eight numbers, in which the kernels are written. Every operation gives the same bits
 * on any processor: there are no reciprocal estimates and no fused multiply-add. The compiler
 * splits a vector where registers are shorter. Kernels only: see kernel.h. */
#ifndef JOLON_RENDERER_SOFT_SIMD8_H
#define JOLON_RENDERER_SOFT_SIMD8_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#ifdef __SSE2__
#include <immintrin.h>
#endif

/* The name of a kernel in this build. Every function of a kernel file that other files call has
 * such a name. */
#ifdef __AVX2__
#define KERNEL(name) name##_avx2
#else
#define KERNEL(name) name##_plain
#endif

#define LANES 8
/* Kernels are fast only when these are inlined with constants. */
#define SIMD8 static inline __attribute__((always_inline))

typedef float v8f __attribute__((vector_size(32)));
typedef int32_t v8i __attribute__((vector_size(32))); /* also masks, whose lanes are 0 or -1 */
typedef uint32_t v8u __attribute__((vector_size(32)));
typedef uint16_t v16s __attribute__((vector_size(32)));
typedef uint8_t v32b __attribute__((vector_size(32)));

SIMD8 v8f simd8_f(float v)
{
    return (v8f){v, v, v, v, v, v, v, v};
}

SIMD8 v8i simd8_i(int32_t v)
{
    return (v8i){v, v, v, v, v, v, v, v};
}

SIMD8 v8u simd8_u(uint32_t v)
{
    return (v8u){v, v, v, v, v, v, v, v};
}

SIMD8 v8i simd8_count(void)
{
    return (v8i){0, 1, 2, 3, 4, 5, 6, 7};
}

/* Loads and stores take memory of any alignment. */
SIMD8 v8f simd8_load_f(const float *from)
{
    v8f v;
    memcpy(&v, from, sizeof v);
    return v;
}

SIMD8 v8u simd8_load_u(const void *from)
{
    v8u v;
    memcpy(&v, from, sizeof v);
    return v;
}

SIMD8 void simd8_store_f(float *to, v8f v)
{
    memcpy(to, &v, sizeof v);
}

SIMD8 void simd8_store_u(void *to, v8u v)
{
    memcpy(to, &v, sizeof v);
}

SIMD8 v8f simd8_to_f(v8i v)
{
    return __builtin_convertvector(v, v8f);
}

/* Rounds towards zero; |v| below 2^31. */
SIMD8 v8i simd8_to_i(v8f v)
{
    return __builtin_convertvector(v, v8i);
}

#ifdef __SSE2__
/* The two halves of a vector, for instructions of 128 bits. */
struct simd8_halves {
    __m128 low, high;
};

SIMD8 struct simd8_halves simd8_split(v8f v)
{
    struct simd8_halves halves;
    memcpy(&halves, &v, sizeof v);
    return halves;
}

SIMD8 v8f simd8_join(__m128 low, __m128 high)
{
    struct simd8_halves halves = {low, high};
    v8f v;
    memcpy(&v, &halves, sizeof v);
    return v;
}
#endif

/* Rounds to the nearest whole number, halves to even; |v| below 2^31. */
SIMD8 v8i simd8_round(v8f v)
{
#if defined(__AVX2__)
    return (v8i)_mm256_cvtps_epi32((__m256)v);
#elif defined(__SSE2__)
    struct simd8_halves x = simd8_split(v);
    return (v8i)simd8_join((__m128)_mm_cvtps_epi32(x.low), (__m128)_mm_cvtps_epi32(x.high));
#else
    v8i i;
    for (int lane = 0; lane < LANES; lane++)
        i[lane] = (int32_t)rintf(v[lane]);
    return i;
#endif
}

/* Round down and up; |v| below 2^31. */
SIMD8 v8i simd8_floor(v8f v)
{
    v8i whole = simd8_to_i(v);
    return whole + (v < simd8_to_f(whole));
}

SIMD8 v8i simd8_ceil(v8f v)
{
    v8i whole = simd8_to_i(v);
    return whole - (v > simd8_to_f(whole));
}

/* Returns a where the mask is -1 and b where it is 0. */
SIMD8 v8f simd8_select(v8i mask, v8f a, v8f b)
{
#ifdef __AVX2__
    return (v8f)_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)mask);
#else
    return (v8f)((mask & (v8i)a) | (~mask & (v8i)b));
#endif
}

SIMD8 v8i simd8_select_i(v8i mask, v8i a, v8i b)
{
    return (v8i)simd8_select(mask, (v8f)a, (v8f)b);
}

SIMD8 v8u simd8_select_u(v8i mask, v8u a, v8u b)
{
    return (v8u)simd8_select(mask, (v8f)a, (v8f)b);
}

/* Return a < b ? a : b and a > b ? a : b, hence b when either is NaN. */
SIMD8 v8f simd8_min(v8f a, v8f b)
{
#if defined(__AVX2__)
    return (v8f)_mm256_min_ps((__m256)a, (__m256)b);
#elif defined(__SSE2__)
    struct simd8_halves x = simd8_split(a), y = simd8_split(b);
    return simd8_join(_mm_min_ps(x.low, y.low), _mm_min_ps(x.high, y.high));
#else
    return simd8_select(a < b, a, b);
#endif
}

SIMD8 v8f simd8_max(v8f a, v8f b)
{
#if defined(__AVX2__)
    return (v8f)_mm256_max_ps((__m256)a, (__m256)b);
#elif defined(__SSE2__)
    struct simd8_halves x = simd8_split(a), y = simd8_split(b);
    return simd8_join(_mm_max_ps(x.low, y.low), _mm_max_ps(x.high, y.high));
#else
    return simd8_select(a > b, a, b);
#endif
}

/* The same for each unsigned byte. */
SIMD8 v8u simd8_min_b(v8u a, v8u b)
{
#if defined(__AVX2__)
    return (v8u)_mm256_min_epu8((__m256i)a, (__m256i)b);
#elif defined(__SSE2__)
    struct simd8_halves x = simd8_split((v8f)a), y = simd8_split((v8f)b);
    return (v8u)simd8_join((__m128)_mm_min_epu8((__m128i)x.low, (__m128i)y.low),
                           (__m128)_mm_min_epu8((__m128i)x.high, (__m128i)y.high));
#else
    v8u less = (v8u)((v32b)a < (v32b)b);
    return (a & less) | (b & ~less);
#endif
}

SIMD8 v8u simd8_max_b(v8u a, v8u b)
{
#if defined(__AVX2__)
    return (v8u)_mm256_max_epu8((__m256i)a, (__m256i)b);
#elif defined(__SSE2__)
    struct simd8_halves x = simd8_split((v8f)a), y = simd8_split((v8f)b);
    return (v8u)simd8_join((__m128)_mm_max_epu8((__m128i)x.low, (__m128i)y.low),
                           (__m128)_mm_max_epu8((__m128i)x.high, (__m128i)y.high));
#else
    v8u less = (v8u)((v32b)a < (v32b)b);
    return (b & less) | (a & ~less);
#endif
}

SIMD8 v8f simd8_clamp(v8f v, float low, float high)
{
    return simd8_min(simd8_max(v, simd8_f(low)), simd8_f(high));
}

SIMD8 v8f simd8_abs(v8f v)
{
    return (v8f)((v8i)v & 0x7fffffff);
}

SIMD8 v8f simd8_sqrt(v8f v)
{
#if defined(__AVX2__)
    return (v8f)_mm256_sqrt_ps((__m256)v);
#elif defined(__SSE2__)
    struct simd8_halves x = simd8_split(v);
    return simd8_join(_mm_sqrt_ps(x.low), _mm_sqrt_ps(x.high));
#else
    for (int i = 0; i < LANES; i++)
        v[i] = sqrtf(v[i]);
    return v;
#endif
}

/* Returns one bit for each lane of a mask, the first lane's lowest. */
SIMD8 uint32_t simd8_bits(v8i mask)
{
#if defined(__AVX2__)
    return (uint32_t)_mm256_movemask_ps((__m256)mask);
#elif defined(__SSE2__)
    struct simd8_halves x = simd8_split((v8f)mask);
    return (uint32_t)(_mm_movemask_ps(x.low) | _mm_movemask_ps(x.high) << 4);
#else
    uint32_t bits = 0;
    for (uint32_t i = 0; i < LANES; i++)
        bits |= ((uint32_t)mask[i] & 1u) << i;
    return bits;
#endif
}

/* Returns one bit for each byte of a mask, whose bytes are 0 or 255. */
SIMD8 uint32_t simd8_bits_b(v32b mask)
{
#if defined(__AVX2__)
    return (uint32_t)_mm256_movemask_epi8((__m256i)mask);
#elif defined(__SSE2__)
    struct simd8_halves x = simd8_split((v8f)mask);
    return (uint32_t)_mm_movemask_epi8((__m128i)x.low) |
           (uint32_t)_mm_movemask_epi8((__m128i)x.high) << 16;
#else
    uint32_t bits = 0;
    for (uint32_t i = 0; i < 32; i++)
        bits |= (mask[i] & 1u) << i;
    return bits;
#endif
}

/* Returns the highest byte of every lane of four vectors, in their order. */
SIMD8 v8u simd8_top_bytes(const v8u four[4])
{
#if defined(__AVX2__)
    __m256i a = _mm256_packus_epi32((__m256i)(four[0] >> 24), (__m256i)(four[1] >> 24));
    __m256i b = _mm256_packus_epi32((__m256i)(four[2] >> 24), (__m256i)(four[3] >> 24));
    return (v8u)_mm256_permutevar8x32_epi32(_mm256_packus_epi16(a, b),
                                            _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7));
#elif defined(__SSE2__)
    __m128i pair[4];
    for (uint32_t i = 0; i < 4; i++) {
        struct simd8_halves x = simd8_split((v8f)(four[i] >> 24));
        pair[i] = _mm_packs_epi32((__m128i)x.low, (__m128i)x.high);
    }
    return (v8u)simd8_join((__m128)_mm_packus_epi16(pair[0], pair[1]),
                           (__m128)_mm_packus_epi16(pair[2], pair[3]));
#else
    v32b tops;
    for (uint32_t i = 0; i < 32; i++)
        tops[i] = (uint8_t)(four[i / LANES][i % LANES] >> 24);
    return (v8u)tops;
#endif
}

/* Returns a mask of the lanes whose bits are set. */
SIMD8 v8i simd8_mask(uint32_t bits)
{
    v8i one = (v8i){1, 2, 4, 8, 16, 32, 64, 128};
    return (simd8_i((int32_t)bits) & one) == one;
}

/* Returns a mask of those numbers x .. x + 7 that lie in first .. end - 1. */
SIMD8 v8i simd8_within(int32_t x, int32_t first, int32_t end)
{
    v8i number = simd8_count() + x;
    return (number >= first) & (number < end);
}

/* --- table look-ups: plain loads, which are as fast as the gather instructions --- */

struct simd8_lanes {
    int32_t lane[LANES];
};

SIMD8 struct simd8_lanes simd8_lanes(v8i v)
{
    struct simd8_lanes lanes;
    memcpy(&lanes, &v, sizeof v);
    return lanes;
}

/* Loads four bytes from each of eight offsets [byte]. */
SIMD8 v8u simd8_gather_bytes(const void *from, v8i at)
{
    const char *first = from;
    struct simd8_lanes lanes = simd8_lanes(at);
    uint32_t t[LANES];
    for (int i = 0; i < LANES; i++)
        memcpy(&t[i], first + lanes.lane[i], sizeof t[i]);
    return (v8u){t[0], t[1], t[2], t[3], t[4], t[5], t[6], t[7]};
}

SIMD8 v8f simd8_gather_f(const float *table, v8i at)
{
    return (v8f)simd8_gather_bytes(table, at << 2);
}

/* The lower and the upper four bytes of eight loads of eight bytes. */
struct simd8_pairs {
    v8u low, high;
};

#ifdef __SSE2__
SIMD8 __m128 simd8_two(const char *first, int32_t a, int32_t b)
{
    int64_t low, high; /* memcpy() allows any alignment */
    memcpy(&low, first + a, sizeof low);
    memcpy(&high, first + b, sizeof high);
    return _mm_castsi128_ps(_mm_set_epi64x(high, low));
}
#endif

SIMD8 struct simd8_pairs simd8_gather_pairs(const void *from, v8i at)
{
    const char *first = from;
    struct simd8_lanes lanes = simd8_lanes(at);
    const int32_t *l = lanes.lane;
#if defined(__AVX2__)
    __m256 a = _mm256_set_m128(simd8_two(first, l[4], l[5]), simd8_two(first, l[0], l[1]));
    __m256 b = _mm256_set_m128(simd8_two(first, l[6], l[7]), simd8_two(first, l[2], l[3]));
    return (struct simd8_pairs){(v8u)_mm256_shuffle_ps(a, b, 0x88),
                                (v8u)_mm256_shuffle_ps(a, b, 0xdd)};
#elif defined(__SSE2__)
    __m128 a = simd8_two(first, l[0], l[1]), b = simd8_two(first, l[2], l[3]);
    __m128 c = simd8_two(first, l[4], l[5]), d = simd8_two(first, l[6], l[7]);
    return (struct simd8_pairs){
        (v8u)simd8_join(_mm_shuffle_ps(a, b, 0x88), _mm_shuffle_ps(c, d, 0x88)),
        (v8u)simd8_join(_mm_shuffle_ps(a, b, 0xdd), _mm_shuffle_ps(c, d, 0xdd))};
#else
    struct simd8_pairs pairs;
    for (int i = 0; i < LANES; i++) {
        uint32_t two[2];
        memcpy(two, first + l[i], sizeof two);
        pairs.low[i] = two[0];
        pairs.high[i] = two[1];
    }
    return pairs;
#endif
}

SIMD8 v8f simd8_mix(v8f a, v8f b, v8f t)
{
    return a + (b - a) * t;
}

SIMD8 v8f simd8_smoothstep(float low, float high, v8f v)
{
    v8f t = simd8_clamp((v - low) * (1.0f / (high - low)), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/* Returns 2^v for v in -126 .. 126, and 2^-126 below. The relative error is below 1e-5. */
SIMD8 v8f simd8_exp2(v8f v)
{
    v8f clamped = simd8_max(v, simd8_f(-126.0f));
    v8i whole = simd8_round(clamped);
    v8f f = clamped - simd8_to_f(whole);
    v8f part = 1.0f + f * (0.69314718f + f * (0.24022651f + f * (0.05550411f + f * 0.00961813f)));
    return (v8f)((v8i)part + (whole << 23));
}

/* Returns e^-v for v >= 0. */
SIMD8 v8f simd8_exp_minus(v8f v)
{
    return simd8_exp2(v * -1.44269504f);
}

/* Returns the exponent of the greatest power of 2 that is not above v; v > 0. */
SIMD8 int32_t power_of_2(float v)
{
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    return (int32_t)(bits >> 23) - 127;
}

SIMD8 v8f simd8_dot3(const v8f a[3], const v8f b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The same with one vector a for all eight. */
SIMD8 v8f simd8_dot3_f(const float a[3], const v8f b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Returns for each lane the sum of the two products of its signed 16-bit halves. */
SIMD8 v8i simd8_add_products(v16s a, v16s b)
{
#if defined(__AVX2__)
    return (v8i)_mm256_madd_epi16((__m256i)a, (__m256i)b);
#elif defined(__SSE2__)
    struct simd8_halves x = simd8_split((v8f)a), y = simd8_split((v8f)b);
    return (v8i)simd8_join((__m128)_mm_madd_epi16((__m128i)x.low, (__m128i)y.low),
                           (__m128)_mm_madd_epi16((__m128i)x.high, (__m128i)y.high));
#else
    v8i x = (v8i)a, y = (v8i)b;
    return (x << 16 >> 16) * (y << 16 >> 16) + (x >> 16) * (y >> 16);
#endif
}

/* Packs a colour of 0..1 to bytes: red lowest, then green, blue; alpha 255. */
SIMD8 v8u simd8_pack(v8f red, v8f green, v8f blue)
{
    v8i r = simd8_to_i(simd8_clamp(red, 0.0f, 1.0f) * 255.0f + 0.5f);
    v8i g = simd8_to_i(simd8_clamp(green, 0.0f, 1.0f) * 255.0f + 0.5f);
    v8i b = simd8_to_i(simd8_clamp(blue, 0.0f, 1.0f) * 255.0f + 0.5f);
    return (v8u)(r | g << 8 | b << 16) | 0xff000000u;
}

/* Returns a byte of each lane, 0..255. */
SIMD8 v8f simd8_byte(v8u texels, int shift)
{
    return simd8_to_f((v8i)((texels >> shift) & 0xffu));
}

#endif
