/* Gridsquares: the 50 km square in 400 x 400 squares of 125 m (Osborne 1991, p. 8, Table 1).
 *
 * Index = row * 400 + column, column from west to east (x), row from north to south (z). Every
 * point is in exactly one square: a point on a border belongs to the square east or south of it,
 * one on or past the world's far edge to the last square. Pure; any thread. */
#ifndef JOLON_WORLD_TERRAIN_GRIDSQUARE_H
#define JOLON_WORLD_TERRAIN_GRIDSQUARE_H

#include <stdint.h>

#define GRIDSQUARE_SIDE_M   125.0
#define GRIDSQUARE_PER_SIDE 400
#define GRIDSQUARE_COUNT    (GRIDSQUARE_PER_SIDE * GRIDSQUARE_PER_SIDE)
#define WORLD_SIDE_M        50000.0

/* The column of x or the row of z [m]: 0..399; NaN gives 0. */
static inline int32_t gridsquare_axis(double metres)
{
    if (!(metres > 0.0))
        return 0;
    if (metres >= WORLD_SIDE_M)
        return GRIDSQUARE_PER_SIDE - 1;
    /* A division, not a multiplication by the reciprocal: the point one ulp before a border must
     * stay before it. */
    return (int32_t)(metres / GRIDSQUARE_SIDE_M);
}

static inline uint32_t gridsquare_index(int32_t column, int32_t row)
{
    return (uint32_t)row * GRIDSQUARE_PER_SIDE + (uint32_t)column;
}

static inline uint32_t gridsquare_of(double x, double z)
{
    return gridsquare_index(gridsquare_axis(x), gridsquare_axis(z));
}

/* The squares that a box of the map touches: columns x0..x1, rows z0..z1, all inclusive. */
struct gridsquare_box {
    int32_t x0, z0, x1, z1;
};

static inline struct gridsquare_box gridsquare_box_of(double min_x, double min_z, double max_x,
                                                      double max_z)
{
    return (struct gridsquare_box){gridsquare_axis(min_x), gridsquare_axis(min_z),
                                   gridsquare_axis(max_x), gridsquare_axis(max_z)};
}

#endif
