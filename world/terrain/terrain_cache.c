/* Heights and water at points under eight bodies at once. */
#include "world/terrain/terrain_cache.h"

#include "world/maths/cpu_dispatch.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#define PATCH_CELLS (TERRAIN_CACHE_SIDE - 1)

/* cell_of() of four. */
static inline void cells_of(const struct terrain *terrain, const f64x4 *metres, four_cells *cell,
                            f64x4 *fraction)
{
    const double last = (double)(terrain->side - 2);
    f64x4 cells = *metres / terrain->spacing_m;
    cells = SIMD_MAX(cells, SIMD_EVERY(0.0));
    cells = SIMD_MIN(cells, SIMD_EVERY(last + 1.0));
    *cell = __builtin_convertvector(SIMD_MIN(cells, SIMD_EVERY(last)), four_cells);
    *fraction = cells - __builtin_convertvector(*cell, f64x4);
}

/* The nearest post's column or row. */
static inline void nearest_of(const struct terrain *terrain, const f64x4 *metres, four_cells *post)
{
    f64x4 fraction;
    cells_of(terrain, metres, post, &fraction);
    *post -= __builtin_convertvector(fraction >= 0.5, four_cells); /* of which true is -1 */
}

/* The first column or row of the patch with a post in its middle, limited to the world. */
static inline void patch_begin(const struct terrain *terrain, four_cells *post)
{
    const int32_t last = (int32_t)terrain->side - TERRAIN_CACHE_SIDE;
    four_cells begin = *post - TERRAIN_CACHE_SIDE / 2;
    begin &= begin > 0;
    four_cells within = begin < last;
    *post = (begin & within) | (last & ~within);
}

/* Returns by how much the slopes between neighbouring posts differ, along their columns and rows
 * together, as a tangent. */
static float bend_of(const struct terrain *terrain, const float *post)
{
    float least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    for (int line = 0; line < TERRAIN_CACHE_SIDE; line++) {
        for (int n = 0; n < PATCH_CELLS; n++) {
            const float *east = post + line * TERRAIN_CACHE_SIDE + n;
            const float *south = post + n * TERRAIN_CACHE_SIDE + line;
            const float rise[2] = {east[1] - east[0], south[TERRAIN_CACHE_SIDE] - south[0]};
            for (int axis = 0; axis < 2; axis++) {
                least[axis] = rise[axis] < least[axis] ? rise[axis] : least[axis];
                most[axis] = rise[axis] > most[axis] ? rise[axis] : most[axis];
            }
        }
    }
    double east_m = (double)(most[0] - least[0]), south_m = (double)(most[1] - least[1]);
    return (float)(sqrt(east_m * east_m + south_m * south_m) / terrain->spacing_m);
}

static void copy_posts(const struct terrain *terrain, struct terrain_cache_entry *patch,
                       uint32_t column, uint32_t row)
{
    *patch = (struct terrain_cache_entry){
        .column = (uint16_t)column, .row = (uint16_t)row, .held = true};
    for (uint32_t i = 0; i < TERRAIN_CACHE_SIDE * TERRAIN_CACHE_SIDE; i++) {
        size_t post = (size_t)(row + i / TERRAIN_CACHE_SIDE) * terrain->side + column +
                      i % TERRAIN_CACHE_SIDE;
        patch->post[i] = terrain->posts[post];
        if (cover_is_water((enum cover)terrain->cover[post]))
            patch->water |= (uint16_t)(1u << i);
    }
    patch->bend = bend_of(terrain, patch->post);
}

VECTOR_CLONES
void terrain_cache_find(const struct terrain *terrain, struct terrain_cache *cache,
                        const union simd_lanes *x, const union simd_lanes *z)
{
    for (int h = 0; h < LANE_FOURS; h++) {
        nearest_of(terrain, &x->f64x4[h], &cache->column.f64x4[h]);
        nearest_of(terrain, &z->f64x4[h], &cache->row.f64x4[h]);
        patch_begin(terrain, &cache->column.f64x4[h]);
        patch_begin(terrain, &cache->row.f64x4[h]);
    }
    for (int l = 0; l < LANE_COUNT; l++) {
        struct terrain_cache_entry *patch = cache->patch[l];
        if (patch->column != cache->column.lane[l] || patch->row != cache->row.lane[l] ||
            !patch->held)
            copy_posts(terrain, patch, (uint32_t)cache->column.lane[l],
                       (uint32_t)cache->row.lane[l]);
    }
}

/* Finds the indices of points in their patches [posts]. Points outside are marked and get 0. */
static inline void find_in_patches(const struct terrain_cache *cache, int h, uint32_t side,
                                   const four_cells *column, const four_cells *row,
                                   four_cells *post, four_cells *outside)
{
    four_cells right = *column - cache->column.f64x4[h], down = *row - cache->row.f64x4[h];
    *outside = ((four_counts)right >= side) | ((four_counts)down >= side);
    *post = (down * TERRAIN_CACHE_SIDE + right) & ~*outside;
}

/* Reads two adjacent posts of each of four cells, beginning with these. */
static inline void two_posts(const float *a, const float *b, const float *c, const float *d,
                             f64x4 *west, f64x4 *east)
{
    double pair[4]; /* their bits */
    memcpy(&pair[0], a, sizeof pair[0]);
    memcpy(&pair[1], b, sizeof pair[1]);
    memcpy(&pair[2], c, sizeof pair[2]);
    memcpy(&pair[3], d, sizeof pair[3]);
    f64x4 even = __builtin_convertvector((four_floats)(two_doubles){pair[0], pair[2]}, f64x4);
    f64x4 odd = __builtin_convertvector((four_floats)(two_doubles){pair[1], pair[3]}, f64x4);
    *west = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
    *east = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
}

/* Heights of four points at once, computed as in base_height(). */
static inline void heights_four(const struct terrain *terrain, const struct terrain_cache *cache,
                                int h, const f64x4 *x, const f64x4 *z, f64x4 *height)
{
    f64x4 u, v, nw, ne, sw, se;
    four_cells column, row, post, outside;
    cells_of(terrain, x, &column, &u);
    cells_of(terrain, z, &row, &v);
    find_in_patches(cache, h, PATCH_CELLS, &column, &row, &post, &outside);
    struct terrain_cache_entry *const *patch = cache->patch + (ptrdiff_t)h * 4;
    const float *a = patch[0]->post + post[0], *b = patch[1]->post + post[1];
    const float *c = patch[2]->post + post[2], *d = patch[3]->post + post[3];
    two_posts(a, b, c, d, &nw, &ne);
    two_posts(a + TERRAIN_CACHE_SIDE, b + TERRAIN_CACHE_SIDE, c + TERRAIN_CACHE_SIDE,
              d + TERRAIN_CACHE_SIDE, &sw, &se);
    four_masks north_east = u >= v;
    f64x4 across = SIMD_CHOOSE(north_east, ne - nw, se - sw);
    f64x4 down = SIMD_CHOOSE(north_east, se - ne, sw - nw);
    *height = nw + across * u + down * v;
    for (int i = 0; (SIMD_ANY_CELL(outside) || terrain->earthworks.count > 0) && i < 4; i++) {
        if (outside[i])
            (*height)[i] = terrain_base_height(terrain, (*x)[i], (*z)[i]);
        else if (terrain->earthworks.count > 0)
            (*height)[i] += earthwork_offset(&terrain->earthworks, (*x)[i], (*z)[i]);
    }
}

VECTOR_CLONES
void terrain_cache_heights(const struct terrain *terrain, const struct terrain_cache *cache,
                           const union simd_lanes *x, const union simd_lanes *z,
                           union simd_lanes *height)
{
    for (int h = 0; h < LANE_FOURS; h++)
        heights_four(terrain, cache, h, &x->f64x4[h], &z->f64x4[h], &height->f64x4[h]);
}

/* An entry holds the posts next to the nearest one of its point. A point that is nearer than a
 * post's spacing in both axes has one of these for its nearest post. */
bool terrain_cache_dry(const struct terrain *terrain, const struct terrain_cache *cache,
                       const union simd_lanes *reach_m)
{
    const f64x4 most = SIMD_EVERY(0.5 * terrain->spacing_m);
    uint32_t water = 0;
    four_masks far = {0};
    for (int l = 0; l < LANE_COUNT; l++)
        water |= cache->patch[l]->water;
    for (int h = 0; h < LANE_FOURS; h++)
        far |= reach_m->f64x4[h] > most;
    return water == 0 && SIMD_ANY(far) == 0;
}

void terrain_cache_bends(const struct terrain_cache *cache, union simd_lanes *bend)
{
    for (int l = 0; l < LANE_COUNT; l++)
        bend->lane[l] = (double)cache->patch[l]->bend;
}

/* patch_begin() of the post that is nearest to a place. */
static uint32_t patch_begin_at(const struct terrain *terrain, double metres)
{
    double post = floor(metres / terrain->spacing_m + 0.5) - TERRAIN_CACHE_SIDE / 2;
    return (uint32_t)maths_clamp(post, 0.0, (double)terrain->side - TERRAIN_CACHE_SIDE);
}

double terrain_cache_bend(const struct terrain *terrain, struct terrain_cache_entry *entry,
                          double x, double z)
{
    uint32_t column = patch_begin_at(terrain, x), row = patch_begin_at(terrain, z);
    if (!entry->held || entry->column != column || entry->row != row)
        copy_posts(terrain, entry, column, row);
    return (double)entry->bend;
}

/* One of cells_of(). */
static inline uint32_t cell_at(const struct terrain *terrain, double metres, double *fraction)
{
    const double last = (double)(terrain->side - 2);
    double cells = maths_clamp(metres / terrain->spacing_m, 0.0, last + 1.0);
    uint32_t cell = (uint32_t)maths_min(cells, last);
    *fraction = cells - (double)cell;
    return cell;
}

void terrain_cache_slopes(const struct terrain *terrain, const struct terrain_cache_entry *entry,
                          double x, double z, double *east, double *south)
{
    double u, v;
    uint32_t right = cell_at(terrain, x, &u) - entry->column;
    uint32_t down = cell_at(terrain, z, &v) - entry->row;
    if (!entry->held || right >= PATCH_CELLS || down >= PATCH_CELLS) {
        (void)terrain_base_plane(terrain, x, z, east, south);
        return;
    }
    size_t north_east = u >= v;
    const float *north = entry->post + (size_t)down * TERRAIN_CACHE_SIDE + right;
    const float *along = north + (1 - north_east) * TERRAIN_CACHE_SIDE;
    const float *side = north + north_east;
    *east = ((double)along[1] - (double)along[0]) / terrain->spacing_m;
    *south = ((double)side[TERRAIN_CACHE_SIDE] - (double)side[0]) / terrain->spacing_m;
}

VECTOR_CLONES
void terrain_cache_water(const struct terrain *terrain, const struct terrain_cache *cache,
                         const union simd_lanes *x, const union simd_lanes *z,
                         union lane_masks *water)
{
    for (int h = 0; h < LANE_FOURS; h++) {
        four_cells column, row, post, outside;
        nearest_of(terrain, &x->f64x4[h], &column);
        nearest_of(terrain, &z->f64x4[h], &row);
        find_in_patches(cache, h, TERRAIN_CACHE_SIDE, &column, &row, &post, &outside);
        struct terrain_cache_entry *const *patch = cache->patch + (ptrdiff_t)h * 4;
        water->f64x4[h] =
            -((four_masks){patch[0]->water >> post[0] & 1, patch[1]->water >> post[1] & 1,
                           patch[2]->water >> post[2] & 1, patch[3]->water >> post[3] & 1});
        for (int i = 0; SIMD_ANY_CELL(outside) && i < 4; i++) {
            if (outside[i])
                water->f64x4[h][i] = -(int64_t)cover_is_water(
                    terrain_cover(terrain, x->f64x4[h][i], z->f64x4[h][i]));
        }
    }
}
