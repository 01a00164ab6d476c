/* Eight numbers at once, for functions that do the same to many bodies: lane l of every argument
 * belongs to body l. AVX2 has vectors of four; other x86-64 processors compute them in pairs. Each
 * operation has the same result as on a single number, on every machine. */
#ifndef JOLON_WORLD_MATHS_SIMD_H
#define JOLON_WORLD_MATHS_SIMD_H

#include <stdint.h>

#define LANE_COUNT 8
#define LANE_FOURS (LANE_COUNT / 4)

typedef double f64x4 __attribute__((vector_size(4 * sizeof(double))));
typedef double two_doubles __attribute__((vector_size(2 * sizeof(double))));
typedef float four_floats __attribute__((vector_size(4 * sizeof(float))));
typedef int64_t four_masks __attribute__((vector_size(4 * sizeof(int64_t))));
typedef int32_t four_cells __attribute__((vector_size(4 * sizeof(int32_t))));
typedef uint32_t four_counts __attribute__((vector_size(4 * sizeof(uint32_t))));
typedef int64_t two_masks __attribute__((vector_size(2 * sizeof(int64_t))));

union simd_lanes {
    double lane[LANE_COUNT];
    f64x4 f64x4[LANE_FOURS];
};

union lane_masks { /* 0 or all ones */
    int64_t lane[LANE_COUNT];
    four_masks f64x4[LANE_FOURS];
};

union lane_cells {
    int32_t lane[LANE_COUNT];
    four_cells f64x4[LANE_FOURS];
};

/* Operations on four lanes. They are macros, since a function with vector arguments has another
 * calling convention with AVX. */
#define SIMD_EVERY(value) ((f64x4){(value), (value), (value), (value)})
#define SIMD_CHOOSE(mask, yes, no)                                                                 \
    ((f64x4)(((mask) & (four_masks)(yes)) | (~(mask) & (four_masks)(no))))
#define SIMD_MIN(a, b)           SIMD_CHOOSE((a) < (b), a, b)
#define SIMD_MAX(a, b)           SIMD_CHOOSE((a) > (b), a, b)
#define SIMD_ABS(a)              ((f64x4)((four_masks)(a)&INT64_MAX))
#define SIMD_NEGATIVE(a)         ((f64x4)((four_masks)(a) ^ INT64_MIN))
#define SIMD_CLAMP(a, low, high) SIMD_CHOOSE((a) < (low), low, SIMD_CHOOSE((a) > (high), high, a))

/* All masks, or cells, or-ed into one number: 0 if none is set. */
#define SIMD_ANY(mask)      ((mask)[0] | (mask)[1] | (mask)[2] | (mask)[3])
#define SIMD_ANY_CELL(cell) (((two_masks)(cell))[0] | ((two_masks)(cell))[1])

#endif
