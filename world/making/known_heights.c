/* Summits, places and the lake. */
#include "world/making/known_heights.h"

#include "world/making/geography.h"
#include "world/maths/maths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SUMMIT_REACH_M  5000.0 /* radius of the ground that moves with a summit */
#define SUMMIT_SEARCH_M 1500.0 /* radius in which erosion may have displaced it */
#define TOP_M           900.0
#define PLACE_REACH_M   2500.0
#define SMOOTH_FREE_M   400.0 /* there is little fine noise this near to an anchor */

/* Width of the fillet between two surfaces that meet in a crease [m]. */
#define FILLET_M 12.0

/* The nodes around a point. */
struct window {
    uint32_t c0, r0, c1, r1; /* inclusive */
};

static double square(double v)
{
    return v * v;
}

static uint32_t node_near(double metres)
{
    double node = floor(metres / ELEVATION_GRID_SPACING_M + ELEVATION_GRID_MARGIN + 0.5);
    return (uint32_t)maths_clamp(node, 0.0, ELEVATION_GRID_SIDE - 1.0);
}

static struct window window_around(double x, double z, double reach_m)
{
    return (struct window){node_near(x - reach_m), node_near(z - reach_m), node_near(x + reach_m),
                           node_near(z + reach_m)};
}

/* Returns 1 in the middle, falling to 0 with no slope at the reach. */
static double bell(double distance_m, double reach_m)
{
    double inside = 1.0 - square(distance_m / reach_m);
    return inside > 0.0 ? square(inside) : 0.0;
}

static double distance_to(const struct anchor *a, uint32_t column, uint32_t row)
{
    return sqrt(square(elevation_grid_metres(column) - a->x) +
                square(elevation_grid_metres(row) - a->z));
}

/* Finds the highest ground within the search radius. */
static void find_top(const struct elevation_grid *grid, const struct anchor *a, double *x,
                     double *z)
{
    struct window w = window_around(a->x, a->z, SUMMIT_SEARCH_M);
    float top = -1.0f;
    *x = a->x;
    *z = a->z;
    for (uint32_t row = w.r0; row <= w.r1; row++) {
        for (uint32_t column = w.c0; column <= w.c1; column++) {
            float height = grid->height[row * ELEVATION_GRID_SIDE + column];
            if (height > top && distance_to(a, column, row) < SUMMIT_SEARCH_M) {
                top = height;
                *x = elevation_grid_metres(column);
                *z = elevation_grid_metres(row);
            }
        }
    }
}

/* Moves the eroded summit to its true place, together with the ground around it. */
static void move_top(struct elevation_grid *grid, const struct anchor *a, float *spare)
{
    double top_x, top_z;
    find_top(grid, a, &top_x, &top_z);
    memcpy(spare, grid->height, ELEVATION_GRID_COUNT * sizeof *spare);
    struct window w = window_around(a->x, a->z, SUMMIT_REACH_M);
    for (uint32_t row = w.r0; row <= w.r1; row++) {
        for (uint32_t column = w.c0; column <= w.c1; column++) {
            double share = bell(distance_to(a, column, row), SUMMIT_REACH_M);
            if (share > 0.0)
                grid->height[row * ELEVATION_GRID_SIDE + column] = (float)elevation_grid_at(
                    spare, elevation_grid_metres(column) + share * (top_x - a->x),
                    elevation_grid_metres(row) + share * (top_z - a->z));
        }
    }
}

/* Rounds a summit: nodes near it become the mean of their surroundings. */
static void round_top(struct elevation_grid *grid, const struct anchor *a, float *spare)
{
    struct window w = window_around(a->x, a->z, TOP_M);
    memcpy(spare, grid->height, ELEVATION_GRID_COUNT * sizeof *spare);
    for (uint32_t row = w.r0; row <= w.r1; row++) {
        for (uint32_t column = w.c0; column <= w.c1; column++) {
            double sum = 0.0, x = elevation_grid_metres(column), z = elevation_grid_metres(row);
            for (int k = 0; k < 9; k++)
                sum += elevation_grid_at(spare, x + (k % 3 - 1) * 150.0, z + (k / 3 - 1) * 150.0);
            float *height = &grid->height[row * ELEVATION_GRID_SIDE + column];
            *height += (float)((sum / 9.0 - *height) * bell(distance_to(a, column, row), TOP_M));
        }
    }
}

/* Raises or lowers the ground so that it is height_m at the anchor. Ground far below changes less,
 * so that valleys keep their floors. */
static void shift(struct elevation_grid *grid, const struct anchor *a, double height_m,
                  double reach_m)
{
    double have = elevation_grid_at(grid->height, a->x, a->z), foot = a->peak ? 0.3 * have : -have;
    struct window w = window_around(a->x, a->z, reach_m);
    for (uint32_t row = w.r0; row <= w.r1; row++) {
        for (uint32_t column = w.c0; column <= w.c1; column++) {
            float *height = &grid->height[row * ELEVATION_GRID_SIDE + column];
            double up = maths_clamp((*height - foot) / (have - foot), 0.0, 1.0);
            *height += (float)((height_m - have) * up * bell(distance_to(a, column, row), reach_m));
        }
    }
}

/* The lower of two heights, with a fillet. */
static double lower(double a, double b)
{
    double near = maths_max(1.0 - fabs(a - b) / FILLET_M, 0.0);
    return maths_min(a, b) - 0.25 * FILLET_M * near * near;
}

/* Lowers ground that is higher than the summit of its ridge; the highest summit limits all
 * ground. */
static void cap(struct elevation_grid *grid, const struct anchor *a, int highest)
{
    for (uint32_t node = 0; node < ELEVATION_GRID_COUNT; node++) {
        double away = distance_to(a, node % ELEVATION_GRID_SIDE, node / ELEVATION_GRID_SIDE);
        double near = maths_min(away, 2500.0);
        double ceiling = a->height_m + 0.25 * FILLET_M - 0.14 * near * near / (near + 250.0);
        if (!highest && away > 4000.0)
            ceiling += 0.3 * (away - 4000.0);
        if (ceiling < grid->height[node] + FILLET_M)
            grid->height[node] = (float)lower(grid->height[node], ceiling);
    }
}

/* Marks every node that water reaches from the drowned river, and the shore around them. */
static int fill_lake(struct elevation_grid *grid)
{
    uint32_t *todo = malloc(4u * ELEVATION_GRID_COUNT * sizeof *todo),
             count = 0; /* once for each neighbour */
    if (!todo)
        return -1;
    const struct geography_line *river = &geography_rivers[GEOGRAPHY_SAN_ANTONIO];
    const struct geography_point *end = &river->points[river->count - 2];
    todo[count++] = node_near(end->z_m) * ELEVATION_GRID_SIDE + node_near(end->x_m);
    while (count > 0) {
        uint32_t node = todo[--count], column = node % ELEVATION_GRID_SIDE,
                 row = node / ELEVATION_GRID_SIDE;
        if (grid->lake[node])
            continue;
        grid->lake[node] = 1;
        if (grid->height[node] >= (float)GEOGRAPHY_LAKE_M)
            continue;
        if (column > 0)
            todo[count++] = node - 1;
        if (column + 1 < ELEVATION_GRID_SIDE)
            todo[count++] = node + 1;
        if (row > 0)
            todo[count++] = node - ELEVATION_GRID_SIDE;
        if (row + 1 < ELEVATION_GRID_SIDE)
            todo[count++] = node + ELEVATION_GRID_SIDE;
    }
    free(todo);
    return 0;
}

int known_heights_set(struct elevation_grid *grid,
                      const struct anchor anchors[GEOGRAPHY_PLACE_COUNT])
{
    float *spare = malloc(ELEVATION_GRID_COUNT * sizeof *spare);
    if (!spare)
        return -1;
    int highest = 1;
    for (int i = 0; i < GEOGRAPHY_PLACE_COUNT; i++) {
        const struct anchor *a = &anchors[i];
        if (a->peak) {
            move_top(grid, a, spare);
            round_top(grid, a, spare);
            shift(grid, a, a->height_m + 0.25 * FILLET_M, SUMMIT_REACH_M);
            cap(grid, a, highest);
            highest = 0;
        } else {
            shift(grid, a, a->height_m, PLACE_REACH_M);
        }
        struct window w = window_around(a->x, a->z, 4.0 * SMOOTH_FREE_M);
        for (uint32_t row = w.r0; row <= w.r1; row++)
            for (uint32_t column = w.c0; column <= w.c1; column++)
                grid->roughness[row * ELEVATION_GRID_SIDE + column] *=
                    (float)(1.0 - bell(distance_to(a, column, row), 4.0 * SMOOTH_FREE_M));
    }
    free(spare);
    return fill_lake(grid);
}
