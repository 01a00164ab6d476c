/* Tiles of ground files. */
#include "world/terrain/ground_tile.h"

#include "world/terrain/terrain.h"

#include <math.h>
#include <string.h>

#define STEPS_LOWEST  (GROUND_LOWEST_M / GROUND_STEP_M)
#define STEPS_HIGHEST (GROUND_HIGHEST_M / GROUND_STEP_M)

struct ground_tile ground_tile_of(uint32_t posts_side, uint32_t number)
{
    uint32_t tiles = ground_tiles_side(posts_side);
    struct ground_tile tile = {.column = number % tiles * GROUND_TILE_POSTS,
                               .row = number / tiles * GROUND_TILE_POSTS};
    uint32_t columns = posts_side - tile.column, rows = posts_side - tile.row;
    tile.columns = columns < GROUND_TILE_POSTS ? columns : GROUND_TILE_POSTS;
    tile.rows = rows < GROUND_TILE_POSTS ? rows : GROUND_TILE_POSTS;
    return tile;
}

float ground_tile_round(double height_m)
{
    return (float)(floor(height_m / GROUND_STEP_M + 0.5) * GROUND_STEP_M);
}

/* What the neighbours let expect; here and above are the first steps of this row and of the row
 * before it. Whole numbers wrap, so any bytes of a file are defined. */
static uint32_t expected(const uint32_t *here, const uint32_t *above, uint32_t column, uint32_t row)
{
    if (row == 0)
        return column == 0 ? 0 : here[column - 1];
    if (column == 0)
        return above[0];
    return here[column - 1] + above[column] - above[column - 1];
}

void ground_tile_pack(const struct ground_tile *tile, const float *posts, const uint8_t *cover,
                      uint32_t posts_side, uint8_t *bytes)
{
    uint32_t steps[2][GROUND_TILE_POSTS], count = tile->columns * tile->rows, at = 0;
    for (uint32_t row = 0; row < tile->rows; row++) {
        uint32_t *here = steps[row & 1], *above = steps[~row & 1];
        size_t first = (size_t)(tile->row + row) * posts_side + tile->column;
        for (uint32_t column = 0; column < tile->columns; column++, at++) {
            here[column] = (uint32_t)(int32_t)((double)posts[first + column] / GROUND_STEP_M);
            uint32_t more = here[column] - expected(here, above, column, row);
            uint32_t stored = more << 1 ^ (more >> 31 ? UINT32_MAX : 0);
            for (uint32_t i = 0; i < 4; i++)
                bytes[i * count + at] = (uint8_t)(stored >> 8 * i);
        }
        memcpy(bytes + 4 * (size_t)count + row * tile->columns, cover + first, tile->columns);
    }
}

bool ground_tile_unpack(const struct ground_tile *tile, const uint8_t *bytes, float *posts,
                        uint8_t *cover, size_t stride)
{
    uint32_t steps[2][GROUND_TILE_POSTS], count = tile->columns * tile->rows, at = 0;
    bool good = true;
    for (uint32_t row = 0; row < tile->rows; row++) {
        uint32_t *here = steps[row & 1], *above = steps[~row & 1];
        const uint8_t *kept = bytes + 4 * (size_t)count + row * tile->columns;
        for (uint32_t column = 0; column < tile->columns; column++, at++) {
            uint32_t stored = (uint32_t)bytes[at] | (uint32_t)bytes[count + at] << 8 |
                              (uint32_t)bytes[2 * count + at] << 16 |
                              (uint32_t)bytes[3 * count + at] << 24;
            uint32_t more = stored >> 1 ^ (stored & 1 ? UINT32_MAX : 0);
            here[column] = expected(here, above, column, row) + more;
            double height = (int32_t)here[column];
            good &= height >= STEPS_LOWEST && height <= STEPS_HIGHEST && kept[column] < COVER_COUNT;
            posts[row * stride + column] = (float)(height * GROUND_STEP_M);
            cover[row * stride + column] = kept[column];
        }
    }
    return good;
}
