/* Gridsquares: the square of a world, divided into squares of 125 m (Osborne 1991, p. 8, Table 1:
 * 400 x 400 in 50 km). Worlds of more than 128 km have squares of 250 or 500 m, so that tables by
 * gridsquare have at most a million rows.
 *
 * Index = row * per_side + column, column from west to east (x), row from north to south (z). Every
 * point is in exactly one square: a point on a border belongs to the square east or south of it,
 * one on or past the world's far edge to the last square. The last row and column may reach beyond
 * the edge. Pure; any thread. */
#ifndef JOLON_WORLD_TERRAIN_GRIDSQUARE_H
#define JOLON_WORLD_TERRAIN_GRIDSQUARE_H

#include <stdint.h>

/* Sides of worlds [m]: whole multiples of WORLD_SIDE_OF_M. */
#define WORLD_SIDE_MIN_M     1000u
#define WORLD_SIDE_MAX_M     500000u
#define WORLD_SIDE_OF_M      125u
#define WORLD_SIDE_DEFAULT_M 50000.0 /* of generated ground, and where nothing says another */

#define GRIDSQUARE_LEAST_M      125.0
#define GRIDSQUARE_PER_SIDE_MAX 1024

/* How a world is divided. */
struct gridsquares {
    double world_m;   /* side of the world */
    double side_m;    /* of a square */
    int32_t per_side; /* squares along an edge */
    uint32_t count;   /* per_side * per_side */
};

/* The division of a world of WORLD_SIDE_DEFAULT_M. */
#define GRIDSQUARES_DEFAULT_INIT                                                                   \
    {                                                                                              \
        WORLD_SIDE_DEFAULT_M, GRIDSQUARE_LEAST_M, 400, 160000                                      \
    }
#define GRIDSQUARES_DEFAULT ((struct gridsquares)GRIDSQUARES_DEFAULT_INIT)

/* Divides a world of this side [m], WORLD_SIDE_MIN_M to WORLD_SIDE_MAX_M. */
static inline struct gridsquares gridsquares_of(double world_m)
{
    struct gridsquares squares = {.world_m = world_m, .side_m = GRIDSQUARE_LEAST_M};
    while (world_m > squares.side_m * GRIDSQUARE_PER_SIDE_MAX)
        squares.side_m *= 2.0;
    squares.per_side = (int32_t)(world_m / squares.side_m);
    squares.per_side += squares.per_side * squares.side_m < world_m;
    squares.count = (uint32_t)squares.per_side * (uint32_t)squares.per_side;
    return squares;
}

/* The column of x or the row of z [m]: 0..per_side - 1; NaN gives 0. */
static inline int32_t gridsquare_axis(const struct gridsquares *squares, double metres)
{
    if (!(metres > 0.0))
        return 0;
    if (metres >= squares->world_m)
        return squares->per_side - 1;
    /* A division, not a multiplication by the reciprocal: the point one ulp before a border must
     * stay before it. */
    return (int32_t)(metres / squares->side_m);
}

static inline uint32_t gridsquare_index(const struct gridsquares *squares, int32_t column,
                                        int32_t row)
{
    return (uint32_t)row * (uint32_t)squares->per_side + (uint32_t)column;
}

static inline int32_t gridsquare_column(const struct gridsquares *squares, uint32_t square)
{
    return (int32_t)(square % (uint32_t)squares->per_side);
}

static inline int32_t gridsquare_row(const struct gridsquares *squares, uint32_t square)
{
    return (int32_t)(square / (uint32_t)squares->per_side);
}

static inline uint32_t gridsquare_of(const struct gridsquares *squares, double x, double z)
{
    return gridsquare_index(squares, gridsquare_axis(squares, x), gridsquare_axis(squares, z));
}

/* The squares that a box of the map touches: columns x0..x1, rows z0..z1, all inclusive. */
struct gridsquare_box {
    int32_t x0, z0, x1, z1;
};

static inline struct gridsquare_box gridsquare_box_of(const struct gridsquares *squares,
                                                      double min_x, double min_z, double max_x,
                                                      double max_z)
{
    return (struct gridsquare_box){gridsquare_axis(squares, min_x), gridsquare_axis(squares, min_z),
                                   gridsquare_axis(squares, max_x),
                                   gridsquare_axis(squares, max_z)};
}

#endif
