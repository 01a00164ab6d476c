/* Gridsquares: the 50 km square in 400 x 400 squares of 125 m (Osborne 1991, p. 8, Table 1).
 *
 * Index = row * 400 + column, column from west to east (x), row from north to south (z). Every
 * point is in exactly one square: a point on a border belongs to the square east or south of it,
 * one on or past the world's far edge to the last square. Pure; any thread. */
#ifndef JOLON_WORLD_SQUARE_H
#define JOLON_WORLD_SQUARE_H

#include <stdint.h>

#define SQUARE_SIDE_M   125.0
#define SQUARE_PER_SIDE 400
#define SQUARE_COUNT    (SQUARE_PER_SIDE * SQUARE_PER_SIDE)
#define WORLD_SIDE_M    50000.0

/* The column of x or the row of z [m]: 0..399; NaN gives 0. */
static inline int32_t square_axis(double metres)
{
    if (!(metres > 0.0))
        return 0;
    if (metres >= WORLD_SIDE_M)
        return SQUARE_PER_SIDE - 1;
    /* Division, not the reciprocal: the point one ulp before a border must stay before it. */
    return (int32_t)(metres / SQUARE_SIDE_M);
}

static inline uint32_t square_index(int32_t column, int32_t row)
{
    return (uint32_t)row * SQUARE_PER_SIDE + (uint32_t)column;
}

static inline uint32_t square_of(double x, double z)
{
    return square_index(square_axis(x), square_axis(z));
}

/* The squares that a box of the map touches: columns x0..x1, rows z0..z1, all inclusive. */
struct square_box {
    int32_t x0, z0, x1, z1;
};

static inline struct square_box square_box_of(double min_x, double min_z, double max_x,
                                              double max_z)
{
    return (struct square_box){square_axis(min_x), square_axis(min_z), square_axis(max_x),
                               square_axis(max_z)};
}

#endif
