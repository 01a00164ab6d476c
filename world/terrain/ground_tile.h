/* The content of a tile of a ground file: heights and cover of up to 256 x 256 posts.
 *
 * A height is a whole number of GROUND_STEP_M. What is stored is its difference from what its
 * neighbours to the west, the north and the north-west let expect (west + north - north-west), with
 * the sign in the lowest bit: first the lowest bytes of all posts, then the next, and so on, and
 * the cover of all posts behind them. Whole numbers alone are added, so reading is exact. Pure; any
 * thread. */
#ifndef JOLON_WORLD_TERRAIN_GROUND_TILE_H
#define JOLON_WORLD_TERRAIN_GROUND_TILE_H

#include "world/terrain/ground_format.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A tile within a ground: its first post, and how many it has. */
struct ground_tile {
    uint32_t column, row, columns, rows;
};

#define GROUND_TILE_BYTES_A_POST 5u
#define GROUND_TILE_BYTES_MAX    (GROUND_TILE_BYTES_A_POST * GROUND_TILE_POSTS * GROUND_TILE_POSTS)

/* number < the square of ground_tiles_side(posts_side). */
struct ground_tile ground_tile_of(uint32_t posts_side, uint32_t number);

static inline uint32_t ground_tile_bytes(const struct ground_tile *tile)
{
    return GROUND_TILE_BYTES_A_POST * tile->columns * tile->rows;
}

/* Returns the height that a file keeps for this one: the nearest whole number of steps. */
float ground_tile_round(double height_m);

/* Writes the tile's content into bytes [ground_tile_bytes()]. posts, cover: of the whole ground,
 * heights from ground_tile_round(). */
void ground_tile_pack(const struct ground_tile *tile, const float *posts, const uint8_t *cover,
                      uint32_t posts_side, uint8_t *bytes);

/* The inverse: fills the tile's posts and cover, of rows that are `stride` posts long; the first
 * belongs to the tile's north-west post. Returns false for a height outside GROUND_LOWEST_M ..
 * GROUND_HIGHEST_M or an unknown cover. */
bool ground_tile_unpack(const struct ground_tile *tile, const uint8_t *bytes, float *posts,
                        uint8_t *cover, size_t stride);

#endif
