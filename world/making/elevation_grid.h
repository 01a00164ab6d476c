/* The land under the posts: heights and what grows where, on one grid of fixed spacing, so that
 * the ground is the same however dense the posts are. Built from the real places (geography.h),
 * noise and running water (stream_erosion.h). */
#ifndef JOLON_WORLD_MAKING_ELEVATION_GRID_H
#define JOLON_WORLD_MAKING_ELEVATION_GRID_H

#include <stdint.h>

/* The grid reaches over the square's edges, so that valleys and ridges run out of it. Node
 * (ELEVATION_GRID_MARGIN, ELEVATION_GRID_MARGIN) lies at (0, 0). */
#define ELEVATION_GRID_SPACING_M 125.0
#define ELEVATION_GRID_MARGIN    36
#define ELEVATION_GRID_SIDE      (400 + 1 + 2 * ELEVATION_GRID_MARGIN)
#define ELEVATION_GRID_COUNT     ((uint32_t)(ELEVATION_GRID_SIDE * ELEVATION_GRID_SIDE))

/* All [ELEVATION_GRID_COUNT], row by row from the north-west. */
struct elevation_grid {
    float *height;    /* [m] below 0 in the sea; the bed's in the lake */
    float *inland;    /* [m] from the coast, negative in the sea */
    float *roughness; /* [m] that finer noise may add or take away */
    float *plain;     /* 0..1: valley floor; 1 beside the river */
    float *stream;    /* 0..1: along creeks; 1 beside large ones */
    float *forest;    /* 0..1: how well trees grow */
    float *chaparral; /* 0..1: how well bushes grow */
    uint8_t *lake;    /* 1: water stands here where the ground is below the lake's surface */
};

/* 0, or -1 with errno ENOMEM. */
int elevation_grid_build(struct elevation_grid *grid, uint64_t seed);
void elevation_grid_free(struct elevation_grid *grid);

/* x of a column, z of a row [m]. */
static inline double elevation_grid_metres(uint32_t column_or_row)
{
    return ((double)column_or_row - (double)ELEVATION_GRID_MARGIN) * ELEVATION_GRID_SPACING_M;
}

/* A field of the land at (x, z) [m], between its four nodes; past the grid the edge goes on. */
double elevation_grid_at(const float *field, double x, double z);

/* Rise over run at a node, to the east and to the south. */
void elevation_grid_gradient(const struct elevation_grid *grid, uint32_t node, double *east,
                             double *south);

#endif
