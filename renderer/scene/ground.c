/* Quadtree selection and patch meshes. */
#include "renderer/scene/ground.h"

#include "world/square.h"

#include <stdlib.h>

#define RING        1  /* squares of 64 km on each side of the world's own */
#define STACK       64 /* depth first: three siblings a level and the roots */
#define SKIRT_SHARE 0.02
#define SKIRT_LEAST 1.5 /* [m] */

/* Patches of all levels above this one: (4^level - 1) / 3. */
static size_t range_offset(int32_t level)
{
    return (((size_t)1 << (2 * level)) - 1) / 3;
}

static struct ground_range *range_at(const struct ground *ground, int32_t level, int32_t column,
                                     int32_t row)
{
    return &ground
                ->range[range_offset(level) + (size_t)row * ((size_t)1 << level) + (size_t)column];
}

static uint32_t post_before(const struct terrain *terrain, double metres)
{
    double post = floor(metres / terrain->spacing_m);
    return (uint32_t)maths_clamp(post, 0.0, (double)terrain->side - 1.0);
}

static struct ground_range posts_range(const struct terrain *terrain, int32_t column, int32_t row)
{
    double side = ground_patch_side(GROUND_RANGE_LEVEL), more = side + terrain->spacing_m;
    uint32_t c0 = post_before(terrain, column * side),
             c1 = post_before(terrain, column * side + more);
    uint32_t r0 = post_before(terrain, row * side), r1 = post_before(terrain, row * side + more);
    float first = terrain->posts[(size_t)r0 * terrain->side + c0];
    struct ground_range range = {first, first};
    for (uint32_t r = r0; r <= r1; r++)
        for (uint32_t c = c0; c <= c1; c++) {
            float y = terrain->posts[(size_t)r * terrain->side + c];
            range.low = y < range.low ? y : range.low;
            range.high = y > range.high ? y : range.high;
        }
    return range;
}

int ground_init(struct ground *ground, const struct terrain *terrain)
{
    ground->terrain = terrain;
    ground->range = malloc(range_offset(GROUND_RANGE_LEVEL + 1) * sizeof *ground->range);
    if (ground->range == NULL)
        return -1;
    for (int32_t row = 0; row < 1 << GROUND_RANGE_LEVEL; row++)
        for (int32_t column = 0; column < 1 << GROUND_RANGE_LEVEL; column++)
            *range_at(ground, GROUND_RANGE_LEVEL, column, row) = posts_range(terrain, column, row);
    for (int32_t level = GROUND_RANGE_LEVEL - 1; level >= 0; level--)
        for (int32_t row = 0; row < 1 << level; row++)
            for (int32_t column = 0; column < 1 << level; column++) {
                struct ground_range all = *range_at(ground, level + 1, 2 * column, 2 * row);
                for (int32_t i = 1; i < 4; i++) {
                    struct ground_range part =
                        *range_at(ground, level + 1, 2 * column + (i & 1), 2 * row + (i >> 1));
                    all.low = part.low < all.low ? part.low : all.low;
                    all.high = part.high > all.high ? part.high : all.high;
                }
                *range_at(ground, level, column, row) = all;
            }
    return 0;
}

void ground_free(struct ground *ground)
{
    free(ground->range);
    ground->range = NULL;
}

static int32_t clamp_index(int32_t value, int32_t count)
{
    return value < 0 ? 0 : value >= count ? count - 1 : value;
}

/* Outside the square the range is that of the nearest patch inside. */
static struct ground_range patch_range(const struct ground *ground,
                                       const struct ground_patch *patch)
{
    int32_t level = patch->level, column = patch->column, row = patch->row;
    if (level > GROUND_RANGE_LEVEL) {
        /* Arithmetic shift rounds down, which is what finds the parent of a negative index. */
        column >>= level - GROUND_RANGE_LEVEL;
        row >>= level - GROUND_RANGE_LEVEL;
        level = GROUND_RANGE_LEVEL;
    }
    int32_t count = 1 << level;
    return *range_at(ground, level, clamp_index(column, count), clamp_index(row, count));
}

static double outside(double value, double low, double high)
{
    return value < low ? low - value : value > high ? value - high : 0.0;
}

/* Sets the patch's distance; false when none of it can be seen. */
static bool patch_seen(const struct ground *ground, const struct camera *camera,
                       struct ground_patch *patch)
{
    double side = ground_patch_side(patch->level);
    struct ground_range range = patch_range(ground, patch);
    double x0 = patch->column * side, z0 = patch->row * side;
    struct vec3 off = {outside(camera->eye.x, x0, x0 + side),
                       outside(camera->eye.y, range.low, range.high),
                       outside(camera->eye.z, z0, z0 + side)};
    patch->distance_m = vec3_length(off);
    /* Skirts hang lower than the lowest post. */
    struct vec3 low = {x0, (double)range.low - SKIRT_SHARE * side - SKIRT_LEAST, z0};
    struct vec3 high = {x0 + side, (double)range.high, z0 + side};
    return camera_sees_box(camera, low, high);
}

static int nearer(const void *a, const void *b)
{
    const struct ground_patch *first = a, *second = b;
    return (first->distance_m > second->distance_m) - (first->distance_m < second->distance_m);
}

uint32_t ground_select(const struct ground *ground, const struct camera *camera,
                       struct ground_patch patches[GROUND_PATCHES_MAX])
{
    struct ground_patch stack[STACK];
    uint32_t depth = 0, count = 0;
    for (int32_t row = -RING; row <= RING; row++)
        for (int32_t column = -RING; column <= RING; column++)
            stack[depth++] = (struct ground_patch){.column = column, .row = row};
    while (depth > 0) {
        struct ground_patch patch = stack[--depth];
        if (!patch_seen(ground, camera, &patch))
            continue;
        /* The last places are kept for the patches that wait: each yields one at least. */
        bool room = count + depth + 4 <= GROUND_PATCHES_MAX && depth + 4 <= STACK;
        bool near = patch.distance_m < GROUND_SPLIT * ground_patch_side(patch.level);
        if (near && room && patch.level < GROUND_LEVEL_MAX) {
            for (int32_t i = 0; i < 4; i++)
                stack[depth++] = (struct ground_patch){.column = 2 * patch.column + (i & 1),
                                                       .row = 2 * patch.row + (i >> 1),
                                                       .level = patch.level + 1};
        } else {
            patches[count++] = patch;
        }
    }
    qsort(patches, count, sizeof *patches, nearer);
    return count;
}

static bool has_crater(const struct crater_index *craters, const struct ground_patch *patch)
{
    double side = ground_patch_side(patch->level);
    double x0 = patch->column * side, z0 = patch->row * side;
    for (uint32_t i = 0; i < craters->count; i++) {
        const struct crater *crater = &craters->craters[i];
        double reach = CRATER_RIM * (double)crater->radius_m;
        if (outside(crater->x, x0, x0 + side) < reach && outside(crater->z, z0, z0 + side) < reach)
            return true;
    }
    return false;
}

/* The furthest that a patch of so many cells is off the heights at its finest cells' corners [m];
 * stops at more than enough. */
static double worst_error(const float *heights, uint32_t finest, uint32_t cells, double enough)
{
    uint32_t stride = finest / cells, posts = finest + 1;
    double worst = 0.0;
    for (uint32_t row = 0; row < finest && worst <= enough; row++)
        for (uint32_t column = 0; column < finest; column++) {
            const float *corner =
                heights + (size_t)(row / stride * stride) * posts + column / stride * stride;
            double u = (double)(column % stride) / stride, v = (double)(row % stride) / stride;
            double nw = (double)corner[0], ne = (double)corner[stride];
            double sw = (double)corner[(size_t)stride * posts];
            double se = (double)corner[(size_t)stride * posts + stride];
            double flat =
                u > v ? nw + (ne - nw) * u + (se - ne) * v : nw + (se - sw) * u + (sw - nw) * v;
            worst = maths_max(worst, fabs(flat - (double)heights[(size_t)row * posts + column]));
        }
    return worst;
}

uint32_t ground_cells(const struct terrain *terrain, const struct crater_index *craters,
                      const struct ground_patch *patch)
{
    if (patch->level >= GROUND_DIG_LEVEL && craters != NULL && has_crater(craters, patch))
        return GROUND_CELLS_MAX;
    double side = ground_patch_side(patch->level);
    double x0 = patch->column * side, z0 = patch->row * side;
    uint32_t finest = 1;
    while (finest < GROUND_CELLS_MAX && finest * terrain->spacing_m < side)
        finest *= 2;
    if (patch->level == GROUND_LEVEL_MAX)
        return finest; /* it may be right before the eye */
    float heights[(GROUND_CELLS_MAX + 1) * (GROUND_CELLS_MAX + 1)];
    for (uint32_t row = 0, n = 0; row <= finest; row++)
        for (uint32_t column = 0; column <= finest; column++, n++)
            heights[n] = (float)terrain_base_height(terrain, x0 + column * side / finest,
                                                    z0 + row * side / finest);
    double enough = GROUND_ERROR * side;
    uint32_t cells = 1;
    while (cells < finest && worst_error(heights, finest, cells, enough) > enough)
        cells *= 2;
    return cells;
}

void ground_vertices(const struct terrain *terrain, const struct crater_index *craters,
                     const struct ground_patch *patch, uint32_t cells, float (*vertices)[3])
{
    double side = ground_patch_side(patch->level), step = side / cells;
    double x0 = patch->column * side, z0 = patch->row * side;
    bool dug = patch->level >= GROUND_DIG_LEVEL;
    uint32_t n = 0, posts = cells + 1;
    for (uint32_t row = 0; row < posts; row++)
        for (uint32_t column = 0; column < posts; column++) {
            double x = column * step, z = row * step;
            double y = terrain_height(terrain, dug ? craters : NULL, x0 + x, z0 + z);
            vertices[n][0] = (float)x;
            vertices[n][1] = (float)y;
            vertices[n][2] = (float)z;
            n++;
        }
    /* The skirt: north, south, west, east edge again, lower. */
    double drop = maths_max(SKIRT_LEAST, SKIRT_SHARE * side);
    for (uint32_t edge = 0; edge < 4; edge++)
        for (uint32_t i = 0; i < posts; i++) {
            uint32_t line = edge & 1 ? cells : 0;
            uint32_t from = edge < 2 ? line * posts + i : i * posts + line;
            vertices[n][0] = vertices[from][0];
            vertices[n][1] = vertices[from][1] - (float)drop;
            vertices[n][2] = vertices[from][2];
            n++;
        }
}

static void put(uint16_t triangle[3], uint32_t a, uint32_t b, uint32_t c)
{
    triangle[0] = (uint16_t)a;
    triangle[1] = (uint16_t)b;
    triangle[2] = (uint16_t)c;
}

void ground_triangles(uint32_t cells, uint16_t (*triangles)[3])
{
    uint32_t n = 0, posts = cells + 1;
    for (uint32_t row = 0; row < cells; row++)
        for (uint32_t column = 0; column < cells; column++) {
            uint32_t north_west = row * posts + column, south_west = north_west + posts;
            put(triangles[n++], north_west, south_west, south_west + 1);
            put(triangles[n++], north_west, south_west + 1, north_west + 1);
        }
    for (uint32_t edge = 0; edge < 4; edge++)
        for (uint32_t i = 0; i < cells; i++) {
            uint32_t line = edge & 1 ? cells : 0;
            uint32_t a = edge < 2 ? line * posts + i : i * posts + line;
            uint32_t b = edge < 2 ? a + 1 : a + posts;
            uint32_t low_a = posts * posts + edge * posts + i, low_b = low_a + 1;
            /* Outside is on opposite sides of the north and the south, the east and the west. */
            bool turned = edge == 1 || edge == 2;
            put(triangles[n++], a, turned ? low_b : b, turned ? b : low_b);
            put(triangles[n++], a, turned ? low_a : low_b, turned ? low_b : low_a);
        }
}
