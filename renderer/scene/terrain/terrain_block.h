/* The posts under a block of a ground texture: heights, slopes and covers row by row. Past the
 * edges of the world the ground continues as in terrain_quadtree_beyond(). */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_BLOCK_H
#define JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_BLOCK_H

#include "world/terrain/terrain.h"

#include <stdbool.h>
#include <stdint.h>

#define TERRAIN_BLOCK_TEXELS 128u /* most texels a side of a block */
#define TERRAIN_BLOCK_MARGIN 3u   /* posts known on each side of it */
#define TERRAIN_BLOCK_POSTS  (TERRAIN_BLOCK_TEXELS + 2u * TERRAIN_BLOCK_MARGIN + 2u)
#define TERRAIN_BLOCK_MIXED  255u /* several covers */

struct terrain_block {
    double
        cell_m; /* distance of the posts used: the terrain's, or a multiple that texels can show */
    int32_t west, north; /* position of the first post used, in cells */
    uint32_t posts;      /* a side */
    uint32_t columns;
    bool sea, wet;                         /* there is sea, or water of any kind, among the posts */
    float level;                           /* of the water [m] */
    int32_t at[TERRAIN_BLOCK_TEXELS];      /* the post west of each column ... */
    float past[TERRAIN_BLOCK_TEXELS];      /* ... and how far past it, in cells */
    double column_x[TERRAIN_BLOCK_TEXELS]; /* in cells from the first post */
    int32_t row; /* the post north of the row; row_past: how far past it */
    float row_past;
    double row_z;
    float height[TERRAIN_BLOCK_POSTS][TERRAIN_BLOCK_POSTS];
    uint8_t cover[TERRAIN_BLOCK_POSTS][TERRAIN_BLOCK_POSTS];
    uint8_t uniform[TERRAIN_BLOCK_POSTS]
                   [TERRAIN_BLOCK_POSTS]; /* the one cover around a cell, or TERRAIN_BLOCK_MIXED */
    uint8_t water[TERRAIN_BLOCK_POSTS]
                 [TERRAIN_BLOCK_POSTS]; /* number of posts of water among the 25 around */
};

/* Opens a block of columns x rows texels that begins at (x, z), step_m apart. */
void terrain_block_open(struct terrain_block *block, const struct terrain *terrain, double x,
                        double z, double step_m, uint32_t columns, uint32_t rows);

/* Moves to the row of texels at z. */
void terrain_block_row(struct terrain_block *block, double z);

/* Fills in the row's heights [m], which equal terrain_base_height() if cells are the terrain's, and
 * slopes: rise a metre to the east and to the south. Slopes are smooth from post to post because
 * flat triangles would show as facets. */
void terrain_block_ground(const struct terrain_block *block, float *height, float *slope_x,
                          float *slope_z);

/* Fills in the row's covers: the cover of a texel if it is the same everywhere that borders can
 * move, else TERRAIN_BLOCK_MIXED. */
void terrain_block_covers(const struct terrain_block *block, uint8_t *covers);

/* Fills in the row's share of water around each texel, 0..1. */
void terrain_block_water(const struct terrain_block *block, float *water);

/* Returns in share the covers at a column of the row, with borders moved by less than one cell. */
void terrain_block_shares(const struct terrain_block *block, uint32_t column, float move_x,
                          float move_z, float share[COVER_COUNT]);

#endif
