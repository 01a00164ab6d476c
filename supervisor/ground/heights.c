/* Heights at posts: sampled from rasters, strip by strip, and voids filled. */
#include "supervisor/ground/heights.h"

#include "supervisor/ground/progress.h"
#include "world/runtime/thread_pool.h"
#include "world/terrain/ground_tile.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define STRIP_ROWS 256u

/* One strip, which the threads share by rows. */
struct post_strip {
    float *posts;
    const struct post_grid *grid;
    struct raster **rasters;
    uint32_t count, first;
    uint64_t (*from)[THREAD_POOL_MAX]; /* [count] by worker */
};

static void sample_rows(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct post_strip *strip = context;
    uint32_t side = strip->grid->side;
    for (uint32_t row = strip->first + first; row < strip->first + end; row++) {
        for (uint32_t column = 0; column < side; column++) {
            double height = NAN;
            for (uint32_t i = 0; i < strip->count && isnan(height); i++) {
                height = raster_height(strip->rasters[i], column, row);
                strip->from[i][worker] += isnan(height) ? 0 : 1;
            }
            strip->posts[(size_t)row * side + column] =
                isnan(height) ? NAN : ground_tile_round(height);
        }
    }
}

static int sample(float *posts, const struct post_grid *grid, struct raster **rasters,
                  uint32_t count, struct thread_pool *pool, struct heights_counts *counts,
                  struct error_text *error)
{
    struct post_strip strip = {posts, grid, rasters, count, 0, calloc(count, sizeof *strip.from)};
    int result = strip.from ? 0 : error_text_memory(error);
    for (; result == 0 && strip.first < grid->side; strip.first += STRIP_ROWS) {
        uint32_t left = grid->side - strip.first, rows = left < STRIP_ROWS ? left : STRIP_ROWS;
        for (uint32_t i = 0; i < count && result == 0; i++)
            result = raster_read(rasters[i], strip.first, rows, error);
        if (result == 0)
            thread_pool_run(pool, sample_rows, &strip, rows, 8);
        progress_show("heights", strip.first + rows, grid->side);
    }
    for (uint32_t i = 0; i < count && strip.from; i++)
        for (uint32_t k = 0; k < THREAD_POOL_MAX; k++)
            counts->from[i] += strip.from[i][k];
    free(strip.from);
    return result;
}

/* Finds the nearest known height of a line, at most `most` posts from the post. Returns the
 * distance [posts], 0: none. */
static uint32_t known(const float *posts, size_t at, ptrdiff_t step, uint32_t room, uint32_t most,
                      float *height)
{
    for (uint32_t i = 1; i <= room && i <= most; i++) {
        *height = posts[(ptrdiff_t)at + (ptrdiff_t)i * step];
        if (!isnan(*height))
            return i;
    }
    return 0;
}

/* Returns the height between the known ones of a row and of a column through a void, the nearer
 * ends counting more; NaN if neither has two ends. */
static float between(const float *posts, const struct post_grid *grid, uint32_t column,
                     uint32_t row, uint32_t most)
{
    size_t at = (size_t)row * grid->side + column;
    const uint32_t room[4] = {column, grid->side - 1 - column, row, grid->side - 1 - row};
    const ptrdiff_t step[4] = {-1, 1, -(ptrdiff_t)grid->side, (ptrdiff_t)grid->side};
    double sum = 0.0, weights = 0.0;
    for (int line = 0; line < 4; line += 2) {
        float low = 0.0f, high = 0.0f;
        double before = known(posts, at, step[line], room[line], most, &low);
        double behind = known(posts, at, step[line + 1], room[line + 1], most, &high);
        if (before == 0.0 || behind == 0.0)
            continue;
        double weight = 1.0 / (before + behind);
        sum += weight * ((double)low * behind + (double)high * before) / (before + behind);
        weights += weight;
    }
    return weights > 0.0 ? ground_tile_round(sum / weights) : NAN;
}

/* Returns a longitude from -180 to 180 degrees. */
static double wrap_degrees(double longitude)
{
    return longitude - 360.0 * round(longitude / 360.0);
}

/* Finds what the rasters cover [deg]: south, west, north, east. West is further than east where
 * they lie across the date line. */
static void extent_of_all(double has[4], const struct post_grid *grid, struct raster **rasters,
                          uint32_t count)
{
    const double none[4] = {90.0, 1e9, -90.0, -1e9};
    memcpy(has, none, sizeof none);
    for (uint32_t i = 0; i < count; i++) {
        double extent[4];
        raster_extent(rasters[i], extent);
        /* Maps count longitudes from -180 or from 0 degrees. */
        double off = 0.5 * (extent[1] + extent[3]) - grid->longitude_deg;
        for (int k = 0; k < 4; k++) {
            double own = k % 2 == 0 ? extent[k] : extent[k] - (off - wrap_degrees(off));
            has[k] = k < 2 ? fmin(has[k], own) : fmax(has[k], own);
        }
    }
    bool around = has[3] - has[1] > 359.9999;
    has[1] = around ? -180.0 : wrap_degrees(has[1]);
    has[3] = around ? 180.0 : wrap_degrees(has[3]);
}

/* Returns true if the middle lies in what the rasters cover once latitude and longitude are
 * exchanged, and not before. */
static bool is_exchanged(const struct post_grid *grid, const double has[4])
{
    double latitude, longitude, middle = grid->projection.middle_m;
    projection_place(&grid->projection, middle, middle, &latitude, &longitude);
    bool within =
        latitude >= has[0] && latitude <= has[2] && longitude >= has[1] && longitude <= has[3];
    return !within && longitude >= has[0] && longitude <= has[2] && latitude >= has[1] &&
           latitude <= has[3];
}

static int refuse_void(const struct post_grid *grid, struct raster **rasters, uint32_t count,
                       size_t post, uint64_t voids, struct error_text *error)
{
    double x = (double)(post % grid->side) * grid->spacing_m;
    double z = (double)(post / grid->side) * grid->spacing_m;
    double latitude, longitude, has[4];
    projection_place(&grid->projection, x, z, &latitude, &longitude);
    extent_of_all(has, grid, rasters, count);
    return error_text_set(
        error,
        "%s%s: no height at latitude %.5f, longitude %.5f (x %.0f, z %.0f m), nor within %g m on "
        "both sides, and so at %" PRIu64 " of %" PRIu64 " posts; the files have latitude %.4f to "
        "%.4f, longitude %.4f to %.4f%s",
        raster_path(rasters[0]), count > 1 ? " and the others" : "", latitude, longitude, x, z,
        HEIGHTS_FILL_M, voids, (uint64_t)grid->side * grid->side, has[0], has[2], has[1], has[3],
        is_exchanged(grid, has) ? ". Is --center LONGITUDE,LATITUDE instead of LATITUDE,LONGITUDE?"
                                : "");
}

static int fill_voids(float *posts, const struct post_grid *grid, struct raster **rasters,
                      uint32_t count, struct heights_counts *counts, struct error_text *error)
{
    size_t all = (size_t)grid->side * grid->side, voids = 0, at = 0;
    uint32_t most = (uint32_t)fmax(1.0, floor(HEIGHTS_FILL_M / grid->spacing_m));
    for (size_t i = 0; i < all; i++) {
        if (isnan(posts[i]) && voids++ == 0)
            counts->first = i;
    }
    counts->filled = voids;
    if (voids == 0)
        return 0;
    size_t first_bad = all;
    uint64_t bad = 0;
    /* From known heights alone: none that is filled here is used for another. */
    float *values = calloc(voids, sizeof *values);
    if (!values)
        return error_text_memory(error);
    for (size_t i = 0; i < all; i++) {
        if (!isnan(posts[i]))
            continue;
        float value =
            between(posts, grid, (uint32_t)(i % grid->side), (uint32_t)(i / grid->side), most);
        first_bad = isnan(value) && first_bad == all ? i : first_bad;
        bad += isnan(value) ? 1 : 0;
        values[at++] = value;
    }
    at = 0;
    for (size_t i = 0; i < all && bad == 0; i++) {
        if (isnan(posts[i]))
            posts[i] = values[at++];
    }
    free(values);
    return bad == 0 ? 0 : refuse_void(grid, rasters, count, first_bad, bad, error);
}

int heights_fill(float *posts, const struct post_grid *grid, struct raster **rasters,
                 uint32_t count, struct thread_pool *pool, struct heights_counts *counts,
                 struct error_text *error)
{
    if (sample(posts, grid, rasters, count, pool, counts, error) != 0)
        return -1;
    return fill_voids(posts, grid, rasters, count, counts, error);
}
