/* Reads the posts under a block and interpolates them along rows. */
#include "renderer/scene/terrain/terrain_block.h"

#include "renderer/scene/noise/value_noise.h"
#include "renderer/scene/terrain/terrain_quadtree.h"

#include <string.h>

static float smooth_step(float low, float high, float v)
{
    float t = (v - low) / (high - low);
    t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
    return t * t * (3.0f - 2.0f * t);
}

/* Returns the cover of a post. Roads are drawn along their lines, so a post's COVER_ROAD is
 * grass. */
static uint8_t cover_of(uint8_t cover)
{
    return cover == COVER_ROAD || cover >= COVER_COUNT ? (uint8_t)COVER_GRASS : cover;
}

static void take_post(struct terrain_block *block, const struct terrain *terrain, uint32_t column,
                      uint32_t row)
{
    int64_t stride = (int64_t)(block->cell_m / terrain->spacing_m);
    int64_t c = (block->west + (int64_t)column) * stride;
    int64_t r = (block->north + (int64_t)row) * stride;
    if (c >= 0 && r >= 0 && c < terrain->side && r < terrain->side) {
        size_t post = (size_t)r * terrain->side + (size_t)c;
        block->height[row][column] = terrain->posts[post];
        block->cover[row][column] = cover_of(terrain->cover[post]);
        return;
    }
    double x = (double)c * terrain->spacing_m, z = (double)r * terrain->spacing_m;
    terrain_quadtree_beyond(terrain, &x, &z);
    block->height[row][column] = (float)terrain_base_height(terrain, x, z);
    block->cover[row][column] = cover_of((uint8_t)terrain_cover(terrain, x, z));
}

/* Finds the cells whose corners and all posts around them have one cover. */
static void find_uniform(struct terrain_block *block)
{
    uint32_t last = block->posts - 2;
    memset(block->uniform, TERRAIN_BLOCK_MIXED, sizeof block->uniform);
    for (uint32_t row = 1; row < last; row++) {
        uint32_t same = 0; /* number of columns so far that have one cover over four posts */
        for (uint32_t column = 0; column < block->posts; column++) {
            uint8_t cover = block->cover[row][column];
            bool one = cover == block->cover[row - 1][column] &&
                       cover == block->cover[row + 1][column] &&
                       cover == block->cover[row + 2][column];
            bool goes_on = column > 0 && cover == block->cover[row][column - 1];
            same = !one ? 0 : goes_on ? same + 1 : 1;
            if (same >= 4)
                block->uniform[row][column - 2] = cover;
        }
    }
}

/* Finds the water and its level. If there are a sea and a lake, the level is that of the sea. */
static void find_water(struct terrain_block *block)
{
    block->sea = block->wet = false;
    block->level = 0.0f;
    for (uint32_t row = 0; row < block->posts; row++)
        for (uint32_t column = 0; column < block->posts; column++) {
            enum cover cover = (enum cover)block->cover[row][column];
            block->sea |= cover == COVER_SEA;
            if (cover_is_water(cover) && !block->sea)
                block->level = block->height[row][column];
            block->wet |= cover_is_water(cover);
        }
    if (block->sea)
        block->level = 0.0f;
}

static void count_water(struct terrain_block *block)
{
    find_water(block);
    if (!block->wet)
        return;
    memset(block->water, 0, sizeof block->water);
    for (uint32_t row = 2; row + 2 < block->posts; row++) {
        uint8_t five[TERRAIN_BLOCK_POSTS];
        for (uint32_t column = 0; column < block->posts; column++) {
            five[column] = 0;
            for (uint32_t r = row - 2; r <= row + 2; r++)
                five[column] += cover_is_water((enum cover)block->cover[r][column]);
        }
        for (uint32_t column = 2; column + 2 < block->posts; column++)
            block->water[row][column] =
                (uint8_t)(five[column - 2] + five[column - 1] + five[column] + five[column + 1] +
                          five[column + 2]);
    }
}

void terrain_block_open(struct terrain_block *block, const struct terrain *terrain, double x,
                        double z, double step_m, uint32_t columns, uint32_t rows)
{
    block->cell_m = terrain->spacing_m;
    while (block->cell_m < step_m)
        block->cell_m *= 2.0;
    double cell = block->cell_m;
    block->west = value_noise_floor(x / cell) - (int32_t)TERRAIN_BLOCK_MARGIN;
    block->north = value_noise_floor(z / cell) - (int32_t)TERRAIN_BLOCK_MARGIN;
    block->columns = columns;
    for (uint32_t i = 0; i < columns; i++) {
        block->column_x[i] = (x + i * step_m) / cell - block->west;
        block->at[i] = value_noise_floor(block->column_x[i]);
        block->past[i] = (float)(block->column_x[i] - block->at[i]);
    }
    uint32_t longer = columns > rows ? columns : rows;
    block->posts =
        (uint32_t)value_noise_floor((longer - 1) * step_m / cell) + 2 + 2 * TERRAIN_BLOCK_MARGIN;
    for (uint32_t row = 0; row < block->posts; row++)
        for (uint32_t column = 0; column < block->posts; column++)
            take_post(block, terrain, column, row);
    find_uniform(block);
    count_water(block);
}

void terrain_block_row(struct terrain_block *block, double z)
{
    block->row_z = z / block->cell_m - block->north;
    block->row = value_noise_floor(block->row_z);
    block->row_past = (float)(block->row_z - block->row);
}

/* --- along a row ------------------------------------------------------------------------------ */

static void spread(const struct terrain_block *block, const float *nodes, float *row)
{
    for (uint32_t i = 0; i < block->columns; i++) {
        const float *node = nodes + block->at[i];
        row[i] = node[0] + (node[1] - node[0]) * block->past[i];
    }
}

static float between(float a, float b, float t)
{
    return a + (b - a) * t;
}

/* Interpolates heights along the row, on the two triangles of each cell. */
static void spread_heights(const struct terrain_block *block, float *height)
{
    const float *north = block->height[block->row], *south = block->height[block->row + 1];
    float v = block->row_past;
    for (uint32_t i = 0; i < block->columns; i++) {
        const float *n = north + block->at[i], *s = south + block->at[i];
        float u = block->past[i];
        float north_east = (n[1] - n[0]) * u + (s[1] - n[1]) * v;
        float south_west = (s[1] - s[0]) * u + (s[0] - n[0]) * v;
        height[i] = n[0] + (u >= v ? north_east : south_west);
    }
}

void terrain_block_ground(const struct terrain_block *block, float *height, float *slope_x,
                          float *slope_z)
{
    float nodes[2][TERRAIN_BLOCK_POSTS] = {{0.0f}};
    const float(*h)[TERRAIN_BLOCK_POSTS] = &block->height[block->row];
    float v = block->row_past, scale = (float)(0.5 / block->cell_m);
    for (uint32_t i = 1; i + 1 < block->posts; i++) {
        nodes[0][i] = scale * between(h[0][i + 1] - h[0][i - 1], h[1][i + 1] - h[1][i - 1], v);
        nodes[1][i] = scale * between(h[1][i] - h[-1][i], h[2][i] - h[0][i], v);
    }
    spread_heights(block, height);
    spread(block, nodes[0], slope_x);
    spread(block, nodes[1], slope_z);
}

void terrain_block_covers(const struct terrain_block *block, uint8_t *covers)
{
    for (uint32_t i = 0; i < block->columns; i++)
        covers[i] = block->uniform[block->row][block->at[i]];
}

void terrain_block_water(const struct terrain_block *block, float *water)
{
    float nodes[TERRAIN_BLOCK_POSTS] = {0.0f};
    const uint8_t *north = block->water[block->row], *south = block->water[block->row + 1];
    for (uint32_t i = 0; i < block->posts; i++)
        nodes[i] = between((float)north[i], (float)south[i], block->row_past) / 25.0f;
    spread(block, nodes, water);
}

void terrain_block_shares(const struct terrain_block *block, uint32_t column, float move_x,
                          float move_z, float share[COVER_COUNT])
{
    double x = block->column_x[column] + (double)move_x, z = block->row_z + (double)move_z;
    int32_t c = value_noise_floor(x), r = value_noise_floor(z);
    /* The ramp is steeper than linear: a border is some metres wide, not a whole cell. */
    float u = smooth_step(0.25f, 0.75f, (float)(x - c));
    float v = smooth_step(0.25f, 0.75f, (float)(z - r));
    for (uint32_t i = 0; i < COVER_COUNT; i++)
        share[i] = 0.0f;
    share[block->cover[r][c]] += (1.0f - u) * (1.0f - v);
    share[block->cover[r][c + 1]] += u * (1.0f - v);
    share[block->cover[r + 1][c]] += (1.0f - u) * v;
    share[block->cover[r + 1][c + 1]] += u * v;
}
