/* Selects the patches of ground. */
#include "renderer/scene/terrain/terrain_quadtree.h"

#include "renderer/scene/noise/value_noise.h"
#include "world/terrain/gridsquare.h"

#include <stdlib.h>

#define RING               1 /* squares of 64 km on each side of the world */
#define BEYOND_ASIDE       0.6
#define BEYOND_ASIDE_MAX_M 2600.0
#define STACK              256      /* depth first: three siblings a level and the roots */
#define LOWEST_M           -1000.0f /* of any ground */
#define HIGHEST_M          9000.0f

/* Returns the number of patches of all levels above this one: (4^level - 1) / 3. */
static size_t range_offset(int32_t level)
{
    return (((size_t)1 << (2 * level)) - 1) / 3;
}

static struct terrain_quadtree_range *range_at(const struct terrain_quadtree *ground, int32_t level,
                                               int32_t column, int32_t row)
{
    return &ground
                ->range[range_offset(level) + (size_t)row * ((size_t)1 << level) + (size_t)column];
}

static uint32_t post_before(const struct terrain *terrain, double metres)
{
    double post = floor(metres / terrain->spacing_m);
    return (uint32_t)maths_clamp(post, 0.0, (double)terrain->side - 1.0);
}

static struct terrain_quadtree_range posts_range(const struct terrain *terrain, int32_t level,
                                                 int32_t column, int32_t row)
{
    double side = terrain_quadtree_patch_side(level), more = side + terrain->spacing_m;
    uint32_t c0 = post_before(terrain, column * side),
             c1 = post_before(terrain, column * side + more);
    uint32_t r0 = post_before(terrain, row * side), r1 = post_before(terrain, row * side + more);
    float first = terrain->posts[(size_t)r0 * terrain->side + c0];
    struct terrain_quadtree_range range = {first, first};
    for (uint32_t r = r0; r <= r1; r++)
        for (uint32_t c = c0; c <= c1; c++) {
            float y = terrain->posts[(size_t)r * terrain->side + c];
            range.low = y < range.low ? y : range.low;
            range.high = y > range.high ? y : range.high;
        }
    const struct gridsquare_box box = gridsquare_box_of(
        &terrain->squares, column * side, row * side, column * side + side, row * side + side);
    double highest, lowest;
    earthwork_range(&terrain->earthworks, &box, &highest, &lowest);
    range.high += (float)highest;
    range.low += (float)lowest;
    return range;
}

void terrain_quadtree_beyond(const struct terrain *terrain, double *x, double *z)
{
    double last = ((double)terrain->side - 1.0) * terrain->spacing_m;
    double in_x = maths_clamp(*x, 0.0, last), in_z = maths_clamp(*z, 0.0, last);
    double out = maths_max(fabs(*x - in_x), fabs(*z - in_z));
    if (!(out > 0.0))
        return;
    double aside = maths_min(BEYOND_ASIDE * out, BEYOND_ASIDE_MAX_M);
    double wave = (double)value_noise_value(*x / 4100.0, *z / 4100.0, 5) +
                  0.4 * (double)value_noise_value(*x / 1300.0, *z / 1300.0, 6);
    *x = maths_clamp(in_x + (*x == in_x ? aside * wave : 0.0), 0.0, last);
    *z = maths_clamp(in_z + (*z == in_z ? aside * wave : 0.0), 0.0, last);
}

int terrain_quadtree_init(struct terrain_quadtree *ground, const struct terrain *terrain)
{
    ground->terrain = terrain;
    ground->range = NULL;
    ground->roots = (int32_t)ceil(terrain->squares.world_m / TERRAIN_QUADTREE_ROOT_M);
    if (ground->roots > 1)
        return 0;
    ground->range = malloc(range_offset(TERRAIN_QUADTREE_RANGE_LEVEL + 1) * sizeof *ground->range);
    if (ground->range == NULL)
        return -1;
    for (int32_t row = 0; row < 1 << TERRAIN_QUADTREE_RANGE_LEVEL; row++)
        for (int32_t column = 0; column < 1 << TERRAIN_QUADTREE_RANGE_LEVEL; column++)
            *range_at(ground, TERRAIN_QUADTREE_RANGE_LEVEL, column, row) =
                posts_range(terrain, TERRAIN_QUADTREE_RANGE_LEVEL, column, row);
    for (int32_t level = TERRAIN_QUADTREE_RANGE_LEVEL - 1; level >= 0; level--)
        for (int32_t row = 0; row < 1 << level; row++)
            for (int32_t column = 0; column < 1 << level; column++) {
                struct terrain_quadtree_range all =
                    *range_at(ground, level + 1, 2 * column, 2 * row);
                for (int32_t i = 1; i < 4; i++) {
                    struct terrain_quadtree_range part =
                        *range_at(ground, level + 1, 2 * column + (i & 1), 2 * row + (i >> 1));
                    all.low = part.low < all.low ? part.low : all.low;
                    all.high = part.high > all.high ? part.high : all.high;
                }
                *range_at(ground, level, column, row) = all;
            }
    return 0;
}

void terrain_quadtree_free(struct terrain_quadtree *ground)
{
    free(ground->range);
    ground->range = NULL;
}

/* The same in a world of several roots: reading all of its posts for the coarse levels would take
 * as long as making it. */
static struct terrain_quadtree_range large_range(const struct terrain_quadtree *ground,
                                                 const struct terrain_quadtree_patch *patch)
{
    double side = terrain_quadtree_patch_side(patch->level);
    double last = ground->terrain->squares.world_m;
    bool inside = patch->column >= 0 && patch->row >= 0 && (patch->column + 1) * side <= last &&
                  (patch->row + 1) * side <= last;
    return inside && patch->level >= TERRAIN_QUADTREE_RANGE_LEVEL
               ? posts_range(ground->terrain, patch->level, patch->column, patch->row)
               : (struct terrain_quadtree_range){LOWEST_M, HIGHEST_M};
}

/* Outside the square the heights may be those of any ground in it. */
static struct terrain_quadtree_range patch_range(const struct terrain_quadtree *ground,
                                                 const struct terrain_quadtree_patch *patch)
{
    int32_t level = patch->level, column = patch->column, row = patch->row;
    if (ground->range == NULL)
        return large_range(ground, patch);
    if (level > TERRAIN_QUADTREE_RANGE_LEVEL) {
        /* An arithmetic shift rounds down, so it finds the parent of a negative index too. */
        column >>= level - TERRAIN_QUADTREE_RANGE_LEVEL;
        row >>= level - TERRAIN_QUADTREE_RANGE_LEVEL;
        level = TERRAIN_QUADTREE_RANGE_LEVEL;
    }
    double side = terrain_quadtree_patch_side(level);
    double last = ((double)ground->terrain->side - 1.0) * ground->terrain->spacing_m;
    bool inside =
        column >= 0 && row >= 0 && (column + 1) * side <= last && (row + 1) * side <= last;
    return inside ? *range_at(ground, level, column, row) : ground->range[0];
}

static double outside(double value, double low, double high)
{
    return value < low ? low - value : value > high ? value - high : 0.0;
}

/* Sets the patch's distance. Returns false if no part of the patch is in view. */
static bool patch_seen(const struct terrain_quadtree *ground, const struct camera *camera,
                       struct terrain_quadtree_patch *patch)
{
    double side = terrain_quadtree_patch_side(patch->level);
    struct terrain_quadtree_range range = patch_range(ground, patch);
    double x0 = patch->column * side, z0 = patch->row * side;
    struct vec3 off = {outside(camera->eye.x, x0, x0 + side),
                       outside(camera->eye.y, range.low, range.high),
                       outside(camera->eye.z, z0, z0 + side)};
    patch->distance_m = vec3_length(off);
    /* Skirts hang below the lowest post. */
    struct vec3 low = {x0, (double)range.low - terrain_quadtree_skirt(patch->level), z0};
    struct vec3 high = {x0 + side, (double)range.high, z0 + side};
    return camera_sees_box(camera, low, high);
}

static int nearer(const void *a, const void *b)
{
    const struct terrain_quadtree_patch *first = a, *second = b;
    return (first->distance_m > second->distance_m) - (first->distance_m < second->distance_m);
}

uint32_t
terrain_quadtree_select(const struct terrain_quadtree *ground, const struct camera *camera,
                        struct terrain_quadtree_patch patches[TERRAIN_QUADTREE_PATCHES_MAX])
{
    struct terrain_quadtree_patch stack[STACK];
    uint32_t depth = 0, count = 0;
    const int32_t last = ground->roots - 1 + RING;
    for (int32_t row = -RING; row <= last; row++)
        for (int32_t column = -RING; column <= last; column++)
            stack[depth++] = (struct terrain_quadtree_patch){.column = column, .row = row};
    while (depth > 0) {
        struct terrain_quadtree_patch patch = stack[--depth];
        if (!patch_seen(ground, camera, &patch))
            continue;
        /* Room is kept for the patches on the stack: each yields at least one. */
        bool room = count + depth + 4 <= TERRAIN_QUADTREE_PATCHES_MAX && depth + 4 <= STACK;
        bool near =
            patch.distance_m < TERRAIN_QUADTREE_SPLIT * terrain_quadtree_patch_side(patch.level);
        if (near && room && patch.level < TERRAIN_QUADTREE_LEVEL_MAX) {
            for (int32_t i = 0; i < 4; i++)
                stack[depth++] =
                    (struct terrain_quadtree_patch){.column = 2 * patch.column + (i & 1),
                                                    .row = 2 * patch.row + (i >> 1),
                                                    .level = patch.level + 1};
        } else {
            patches[count++] = patch;
        }
    }
    qsort(patches, count, sizeof *patches, nearer);
    return count;
}
