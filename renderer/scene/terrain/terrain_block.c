/* Posts under a block. */
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

/* The cover of a post; roads are painted by their own lines, so a post's COVER_ROAD is grass. */
static uint8_t cover_of(uint8_t cover)
{
    return cover == COVER_ROAD || cover >= COVER_COUNT ? (uint8_t)COVER_GRASS : cover;
}

static void take_post(struct terrain_block *country, const struct terrain *terrain, uint32_t column,
                      uint32_t row)
{
    int64_t stride = (int64_t)(country->cell_m / terrain->spacing_m);
    int64_t c = (country->west + (int64_t)column) * stride;
    int64_t r = (country->north + (int64_t)row) * stride;
    if (c >= 0 && r >= 0 && c < terrain->side && r < terrain->side) {
        size_t post = (size_t)r * terrain->side + (size_t)c;
        country->height[row][column] = terrain->posts[post];
        country->cover[row][column] = cover_of(terrain->cover[post]);
        return;
    }
    double x = (double)c * terrain->spacing_m, z = (double)r * terrain->spacing_m;
    terrain_quadtree_beyond(terrain, &x, &z);
    country->height[row][column] = (float)terrain_base_height(terrain, x, z);
    country->cover[row][column] = cover_of((uint8_t)terrain_cover(terrain, x, z));
}

/* A cell's corners and all the posts around them. */
static void find_whole(struct terrain_block *country)
{
    uint32_t last = country->posts - 2;
    memset(country->whole, TERRAIN_BLOCK_MIXED, sizeof country->whole);
    for (uint32_t row = 1; row < last; row++) {
        uint32_t same = 0; /* columns so far that are of one cover, each over four posts */
        for (uint32_t column = 0; column < country->posts; column++) {
            uint8_t cover = country->cover[row][column];
            bool one = cover == country->cover[row - 1][column] &&
                       cover == country->cover[row + 1][column] &&
                       cover == country->cover[row + 2][column];
            bool goes_on = column > 0 && cover == country->cover[row][column - 1];
            same = !one ? 0 : goes_on ? same + 1 : 1;
            if (same >= 4)
                country->whole[row][column - 2] = cover;
        }
    }
}

/* What water there is, and how high it stands: of a sea and a lake the sea, which has tides. */
static void find_water(struct terrain_block *country)
{
    country->sea = country->wet = false;
    country->level = 0.0f;
    for (uint32_t row = 0; row < country->posts; row++)
        for (uint32_t column = 0; column < country->posts; column++) {
            enum cover cover = (enum cover)country->cover[row][column];
            country->sea |= cover == COVER_SEA;
            if (cover_is_water(cover) && !country->sea)
                country->level = country->height[row][column];
            country->wet |= cover_is_water(cover);
        }
    if (country->sea)
        country->level = 0.0f;
}

static void count_water(struct terrain_block *country)
{
    find_water(country);
    if (!country->wet)
        return;
    memset(country->water, 0, sizeof country->water);
    for (uint32_t row = 2; row + 2 < country->posts; row++) {
        uint8_t five[TERRAIN_BLOCK_POSTS];
        for (uint32_t column = 0; column < country->posts; column++) {
            five[column] = 0;
            for (uint32_t r = row - 2; r <= row + 2; r++)
                five[column] += cover_is_water((enum cover)country->cover[r][column]);
        }
        for (uint32_t column = 2; column + 2 < country->posts; column++)
            country->water[row][column] =
                (uint8_t)(five[column - 2] + five[column - 1] + five[column] + five[column + 1] +
                          five[column + 2]);
    }
}

void terrain_block_open(struct terrain_block *country, const struct terrain *terrain, double x,
                        double z, double step_m, uint32_t columns, uint32_t rows)
{
    country->cell_m = terrain->spacing_m;
    while (country->cell_m < step_m)
        country->cell_m *= 2.0;
    double cell = country->cell_m;
    country->west = value_noise_floor(x / cell) - (int32_t)TERRAIN_BLOCK_MARGIN;
    country->north = value_noise_floor(z / cell) - (int32_t)TERRAIN_BLOCK_MARGIN;
    country->columns = columns;
    for (uint32_t i = 0; i < columns; i++) {
        country->column_x[i] = (x + i * step_m) / cell - country->west;
        country->at[i] = value_noise_floor(country->column_x[i]);
        country->past[i] = (float)(country->column_x[i] - country->at[i]);
    }
    uint32_t longer = columns > rows ? columns : rows;
    country->posts =
        (uint32_t)value_noise_floor((longer - 1) * step_m / cell) + 2 + 2 * TERRAIN_BLOCK_MARGIN;
    for (uint32_t row = 0; row < country->posts; row++)
        for (uint32_t column = 0; column < country->posts; column++)
            take_post(country, terrain, column, row);
    find_whole(country);
    count_water(country);
}

void terrain_block_row(struct terrain_block *country, double z)
{
    country->row_z = z / country->cell_m - country->north;
    country->row = value_noise_floor(country->row_z);
    country->row_past = (float)(country->row_z - country->row);
}

/* --- along a row ------------------------------------------------------------------------------ */

static void spread(const struct terrain_block *country, const float *nodes, float *row)
{
    for (uint32_t i = 0; i < country->columns; i++) {
        const float *node = nodes + country->at[i];
        row[i] = node[0] + (node[1] - node[0]) * country->past[i];
    }
}

static float between(float a, float b, float t)
{
    return a + (b - a) * t;
}

/* Along the row, on the two triangles of each cell. */
static void spread_heights(const struct terrain_block *country, float *height)
{
    const float *north = country->height[country->row], *south = country->height[country->row + 1];
    float v = country->row_past;
    for (uint32_t i = 0; i < country->columns; i++) {
        const float *n = north + country->at[i], *s = south + country->at[i];
        float u = country->past[i];
        float north_east = (n[1] - n[0]) * u + (s[1] - n[1]) * v;
        float south_west = (s[1] - s[0]) * u + (s[0] - n[0]) * v;
        height[i] = n[0] + (u >= v ? north_east : south_west);
    }
}

void terrain_block_ground(const struct terrain_block *country, float *height, float *slope_x,
                          float *slope_z)
{
    float nodes[2][TERRAIN_BLOCK_POSTS] = {{0.0f}};
    const float(*h)[TERRAIN_BLOCK_POSTS] = &country->height[country->row];
    float v = country->row_past, scale = (float)(0.5 / country->cell_m);
    for (uint32_t i = 1; i + 1 < country->posts; i++) {
        nodes[0][i] = scale * between(h[0][i + 1] - h[0][i - 1], h[1][i + 1] - h[1][i - 1], v);
        nodes[1][i] = scale * between(h[1][i] - h[-1][i], h[2][i] - h[0][i], v);
    }
    spread_heights(country, height);
    spread(country, nodes[0], slope_x);
    spread(country, nodes[1], slope_z);
}

void terrain_block_covers(const struct terrain_block *country, uint8_t *covers)
{
    for (uint32_t i = 0; i < country->columns; i++)
        covers[i] = country->whole[country->row][country->at[i]];
}

void terrain_block_water(const struct terrain_block *country, float *water)
{
    float nodes[TERRAIN_BLOCK_POSTS] = {0.0f};
    const uint8_t *north = country->water[country->row], *south = country->water[country->row + 1];
    for (uint32_t i = 0; i < country->posts; i++)
        nodes[i] = between((float)north[i], (float)south[i], country->row_past) / 25.0f;
    spread(country, nodes, water);
}

void terrain_block_shares(const struct terrain_block *country, uint32_t column, float move_x,
                          float move_z, float share[COVER_COUNT])
{
    double x = country->column_x[column] + (double)move_x, z = country->row_z + (double)move_z;
    int32_t c = value_noise_floor(x), r = value_noise_floor(z);
    /* Steeper than linear: a border is some metres wide, not a whole cell. */
    float u = smooth_step(0.25f, 0.75f, (float)(x - c));
    float v = smooth_step(0.25f, 0.75f, (float)(z - r));
    for (uint32_t i = 0; i < COVER_COUNT; i++)
        share[i] = 0.0f;
    share[country->cover[r][c]] += (1.0f - u) * (1.0f - v);
    share[country->cover[r][c + 1]] += u * (1.0f - v);
    share[country->cover[r + 1][c]] += (1.0f - u) * v;
    share[country->cover[r + 1][c + 1]] += u * v;
}
