/* The posts under a block of a painting: heights, slopes and covers row by row. Past the square's
 * edges the country goes on as terrain_quadtree_beyond() has it. */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_BLOCK_H
#define JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_BLOCK_H

#include "world/terrain/terrain.h"

#include <stdbool.h>
#include <stdint.h>

#define TERRAIN_BLOCK_TEXELS 128u /* a side of a block at most */
#define TERRAIN_BLOCK_MARGIN 3u   /* posts known on each side of it */
#define TERRAIN_BLOCK_POSTS  (TERRAIN_BLOCK_TEXELS + 2u * TERRAIN_BLOCK_MARGIN + 2u)
#define TERRAIN_BLOCK_MIXED  255u /* no one cover */

struct terrain_block {
    double cell_m; /* between the posts taken: the terrain's own, or so many as texels can show */
    int32_t west, north; /* of the first post taken, in cells */
    uint32_t posts;      /* a side */
    uint32_t columns;
    bool sea, wet;                         /* there is sea, is water of any kind, among the posts */
    float level;                           /* of the water [m] */
    int32_t at[TERRAIN_BLOCK_TEXELS];      /* the post west of each column ... */
    float past[TERRAIN_BLOCK_TEXELS];      /* ... and how far past it, in cells */
    double column_x[TERRAIN_BLOCK_TEXELS]; /* in cells from the first post */
    int32_t row;                           /* the post north of the row, and how far past it */
    float row_past;
    double row_z;
    float height[TERRAIN_BLOCK_POSTS][TERRAIN_BLOCK_POSTS];
    uint8_t cover[TERRAIN_BLOCK_POSTS][TERRAIN_BLOCK_POSTS];
    uint8_t whole[TERRAIN_BLOCK_POSTS]
                 [TERRAIN_BLOCK_POSTS]; /* cover all around a cell, or TERRAIN_BLOCK_MIXED */
    uint8_t water[TERRAIN_BLOCK_POSTS]
                 [TERRAIN_BLOCK_POSTS]; /* posts of water among the 25 around */
};

/* A block of columns x columns texels from (x, z) on, step_m apart. */
void terrain_block_open(struct terrain_block *block, const struct terrain *terrain, double x,
                        double z, double step_m, uint32_t columns, uint32_t rows);

/* Goes to the row of texels at z. */
void terrain_block_row(struct terrain_block *block, double z);

/* Along the row: height [m] as terrain_base_height() has it where cells are the terrain's, and
 * slopes as if the ground bent smoothly from post to post (flat triangles would show as facets):
 * rise a metre to the east, to the south. */
void terrain_block_ground(const struct terrain_block *block, float *height, float *slope_x,
                          float *slope_z);

/* Along the row: the cover of each texel when it is the same as far around its cell as borders can
 * be shaken, else TERRAIN_BLOCK_MIXED. */
void terrain_block_covers(const struct terrain_block *block, uint8_t *covers);

/* Along the row: how much water lies around, 0..1. */
void terrain_block_water(const struct terrain_block *block, float *water);

/* Shares of the covers at a column of the row, its borders moved by so many cells, less than one.
 */
void terrain_block_shares(const struct terrain_block *block, uint32_t column, float move_x,
                          float move_z, float share[COVER_COUNT]);

#endif
