/* The elevation grid: heights and vegetation on a grid of fixed spacing, so that the ground does
 * not depend on the spacing of the posts. Built from the real places (geography.h), noise and
 * erosion (stream_erosion.h). */
#ifndef JOLON_WORLD_MAKING_ELEVATION_GRID_H
#define JOLON_WORLD_MAKING_ELEVATION_GRID_H

#include <stdint.h>

/* The grid extends beyond the square's edges, so that valleys and ridges continue there. Node
 * (ELEVATION_GRID_MARGIN, ELEVATION_GRID_MARGIN) lies at (0, 0). */
#define ELEVATION_GRID_SPACING_M 125.0
#define ELEVATION_GRID_MARGIN    36
#define ELEVATION_GRID_SIDE      (400 + 1 + 2 * ELEVATION_GRID_MARGIN)
#define ELEVATION_GRID_COUNT     ((uint32_t)(ELEVATION_GRID_SIDE * ELEVATION_GRID_SIDE))

/* All [ELEVATION_GRID_COUNT], row by row from the north-west. */
struct elevation_grid {
    float *height;    /* [m] below 0 in the sea; the bed's in the lake */
    float *inland;    /* [m] from the coast, negative in the sea */
    float *roughness; /* [m] amplitude of finer noise */
    float *plain;     /* 0..1: valley floor; 1 beside the river */
    float *stream;    /* 0..1: along creeks; 1 beside large ones */
    float *forest;    /* 0..1: how well trees grow */
    float *chaparral; /* 0..1: how well bushes grow */
    uint8_t *lake;    /* 1: under water where the ground is below the lake's surface */
};

/* 0, or -1 with errno ENOMEM. */
int elevation_grid_build(struct elevation_grid *grid, uint64_t seed);
void elevation_grid_free(struct elevation_grid *grid);

/* x of a column, z of a row [m]. */
static inline double elevation_grid_metres(uint32_t column_or_row)
{
    return ((double)column_or_row - (double)ELEVATION_GRID_MARGIN) * ELEVATION_GRID_SPACING_M;
}

/* Returns a field of the elevation grid at (x, z) [m], interpolated between four nodes; outside the
 * grid that of its edge. */
double elevation_grid_at(const float *field, double x, double z);

/* Returns rise over run at a node, to the east and to the south. */
void elevation_grid_gradient(const struct elevation_grid *grid, uint32_t node, double *east,
                             double *south);

#endif
