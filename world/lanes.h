/* Eight numbers at once, for functions that do the same to many bodies: lane l of every argument
 * belongs to body l. Vectors of four are what AVX2 has; any x86-64 does them in twos. Each
 * operation has one result on every machine, that of the same operation on one number. */
#ifndef JOLON_WORLD_LANES_H
#define JOLON_WORLD_LANES_H

#include <stdint.h>

#define LANE_COUNT 8
#define LANE_FOURS (LANE_COUNT / 4)

typedef double four __attribute__((vector_size(4 * sizeof(double))));
typedef double two_doubles __attribute__((vector_size(2 * sizeof(double))));
typedef float four_floats __attribute__((vector_size(4 * sizeof(float))));
typedef int64_t four_masks __attribute__((vector_size(4 * sizeof(int64_t))));
typedef int32_t four_cells __attribute__((vector_size(4 * sizeof(int32_t))));
typedef uint32_t four_counts __attribute__((vector_size(4 * sizeof(uint32_t))));
typedef int64_t two_masks __attribute__((vector_size(2 * sizeof(int64_t))));

union lanes {
    double lane[LANE_COUNT];
    four four[LANE_FOURS];
};

union lane_masks { /* 0 or all ones */
    int64_t lane[LANE_COUNT];
    four_masks four[LANE_FOURS];
};

union lane_cells {
    int32_t lane[LANE_COUNT];
    four_cells four[LANE_FOURS];
};

/* Of fours. Macros, since a function with vectors for arguments is another one where there is AVX.
 */
#define LANES_EVERY(value) ((four){(value), (value), (value), (value)})
#define LANES_CHOOSE(mask, yes, no)                                                                \
    ((four)(((mask) & (four_masks)(yes)) | (~(mask) & (four_masks)(no))))
#define LANES_MIN(a, b)   LANES_CHOOSE((a) < (b), a, b)
#define LANES_MAX(a, b)   LANES_CHOOSE((a) > (b), a, b)
#define LANES_ABS(a)      ((four)((four_masks)(a)&INT64_MAX))
#define LANES_NEGATIVE(a) ((four)((four_masks)(a) ^ INT64_MIN))
#define LANES_CLAMP(a, low, high)                                                                  \
    LANES_CHOOSE((a) < (low), low, LANES_CHOOSE((a) > (high), high, a))

/* Every mask, or cell, in one number: 0 when none is set. */
#define LANES_ANY(mask)      ((mask)[0] | (mask)[1] | (mask)[2] | (mask)[3])
#define LANES_ANY_CELL(cell) (((two_masks)(cell))[0] | ((two_masks)(cell))[1])

#endif
