/* The square's posts and their cover from the elevation grid: cubic interpolation and finer
 * noise. */
#include "world/making/generate.h"

#include "world/making/generate_roads.h"
#include "world/making/geography.h"
#include "world/making/elevation_grid.h"
#include "world/maths/maths.h"
#include "world/maths/noise.h"
#include "world/maths/random.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* WGS 84, and the square's centre. */
#define EARTH_A_M        6378137.0
#define EARTH_F          (1.0 / 298.257223563)
#define CENTRE_LATITUDE  35.95
#define CENTRE_LONGITUDE (-121.25)

/* Least height of land over the sea [m]. */
#define LAND_MIN_M 0.7f

/* Amplitude of the shore's winding about the elevation grid's shore [m]. */
#define SHORE_M 35.0f

/* Roads are shown if posts are closer than this: a post's cover is as wide as the posts'
 * spacing. */
#define ROAD_SPACING_M 40.0
#define ROAD_HALF_M    20.0

enum { NOISE_DETAIL = 1000, NOISE_EDGE = 1100 };

void generate_place(double latitude_deg, double longitude_deg, double *x, double *z)
{
    const double e2 = EARTH_F * (2.0 - EARTH_F);
    double sine, cosine, sine_there, cosine_there;
    maths_sincos(CENTRE_LATITUDE * RAD_PER_DEG, &sine, &cosine);
    maths_sincos(latitude_deg * RAD_PER_DEG, &sine_there, &cosine_there);
    double w2 = 1.0 - e2 * sine * sine, normal_m = EARTH_A_M / sqrt(w2);
    double meridian_m = normal_m * (1.0 - e2) / w2;
    double north = (latitude_deg - CENTRE_LATITUDE) * RAD_PER_DEG;
    double east = (longitude_deg - CENTRE_LONGITUDE) * RAD_PER_DEG;
    /* Second order: parallels are shorter in the north, and curved. */
    *x = 0.5 * WORLD_SIDE_DEFAULT_M + normal_m * cosine_there * east;
    *z = 0.5 * WORLD_SIDE_DEFAULT_M - meridian_m * north -
         0.5 * normal_m * sine * cosine * east * east;
}

void generate_flat(float *posts, uint8_t *cover, uint32_t side, double height_m)
{
    size_t count = (size_t)side * side;
    for (size_t i = 0; i < count; i++)
        posts[i] = (float)height_m;
    memset(cover, COVER_GRASS, count);
}

/* The position of a post between the columns of nodes. */
struct between {
    uint32_t west;  /* the node before it */
    float share;    /* of the distance to the next node */
    float cubic[4]; /* weights of the node before that one, of it and of the two after it */
};

/* Works on one row of posts at a time: fields of the elevation grid and noise along it. */
struct weave {
    const struct elevation_grid *grid;
    uint64_t seed;
    uint32_t side;
    double spacing_m;
    struct between *between;                                         /* [side] */
    float *inland, *height, *roughness, *forest, *chaparral, *noise; /* [side] */
    float *memory;
};

#define WEAVE_ROWS 6

/* Catmull-Rom weights between the second and the third of four values. */
static void cubic_weights(double t, float weight[4])
{
    weight[0] = (float)(0.5 * t * (t * (2.0 - t) - 1.0));
    weight[1] = (float)(0.5 * (t * t * (3.0 * t - 5.0) + 2.0));
    weight[2] = (float)(0.5 * t * (t * (4.0 - 3.0 * t) + 1.0));
    weight[3] = (float)(0.5 * t * t * (t - 1.0));
}

static void weave_free(struct weave *w)
{
    free(w->memory);
    free(w->between);
}

static int weave_init(struct weave *w, const struct elevation_grid *grid, uint32_t side,
                      uint64_t seed)
{
    *w = (struct weave){.grid = grid, .seed = seed, .side = side};
    w->spacing_m = WORLD_SIDE_DEFAULT_M / (double)(side - 1);
    w->memory = malloc((size_t)side * WEAVE_ROWS * sizeof *w->memory);
    w->between = malloc(side * sizeof *w->between);
    if (!w->memory || !w->between) {
        weave_free(w);
        return -1;
    }
    float **rows[WEAVE_ROWS] = {&w->inland, &w->height,    &w->roughness,
                                &w->forest, &w->chaparral, &w->noise};
    for (size_t i = 0; i < WEAVE_ROWS; i++)
        *rows[i] = w->memory + i * side;
    for (uint32_t i = 0; i < side; i++) {
        double u = (double)i * w->spacing_m / ELEVATION_GRID_SPACING_M + ELEVATION_GRID_MARGIN,
               west = floor(u);
        w->between[i].west = (uint32_t)west;
        w->between[i].share = (float)(u - west);
        cubic_weights(u - west, w->between[i].cubic);
    }
    return 0;
}

/* Computes the heights of a row of posts: first interpolates between the four rows of nodes around
 * it. */
static void weave_heights(struct weave *w, double z)
{
    double v = z / ELEVATION_GRID_SPACING_M + ELEVATION_GRID_MARGIN, row = floor(v);
    const float *from = w->grid->height + ((size_t)row - 1) * ELEVATION_GRID_SIDE;
    float line[ELEVATION_GRID_SIDE], k[4];
    cubic_weights(v - row, k);
    for (uint32_t i = 0; i < ELEVATION_GRID_SIDE; i++)
        line[i] = k[0] * from[i] + k[1] * from[i + ELEVATION_GRID_SIDE] +
                  k[2] * from[i + 2 * ELEVATION_GRID_SIDE] +
                  k[3] * from[i + 3 * ELEVATION_GRID_SIDE];
    for (uint32_t i = 0; i < w->side; i++) {
        const float *p = line + w->between[i].west - 1, *c = w->between[i].cubic;
        w->height[i] = c[0] * p[0] + c[1] * p[1] + c[2] * p[2] + c[3] * p[3];
    }
}

static void weave_field(struct weave *w, const float *field, double z, float *out)
{
    double v = z / ELEVATION_GRID_SPACING_M + ELEVATION_GRID_MARGIN, row = floor(v);
    const float *from = field + (size_t)row * ELEVATION_GRID_SIDE;
    float line[ELEVATION_GRID_SIDE], down = (float)(v - row);
    for (uint32_t i = 0; i < ELEVATION_GRID_SIDE; i++)
        line[i] = from[i] + (from[i + ELEVATION_GRID_SIDE] - from[i]) * down;
    for (uint32_t i = 0; i < w->side; i++) {
        const float *p = line + w->between[i].west;
        out[i] = p[0] + (p[1] - p[0]) * w->between[i].share;
    }
}

static void weave_noise(struct weave *w, uint64_t seed, double wavelength_m, int octaves, double z)
{
    struct noise_row row = {0.0, w->spacing_m, z, w->side};
    memset(w->noise, 0, w->side * sizeof *w->noise);
    noise_add_fractal_row(w->seed + seed, wavelength_m, 1.0, octaves, row, w->noise);
}

/* Returns the height of one post and whether it is water; row is the nearest row of nodes. */
static float place_post(const struct weave *w, uint32_t i, uint32_t row, uint8_t *cover)
{
    *cover = COVER_SEA;
    if (w->inland[i] + SHORE_M * w->noise[i] <= 0.0f)
        return 0.0f;
    float height = w->height[i] + w->roughness[i] * w->noise[i];
    uint32_t column = w->between[i].west + (w->between[i].share >= 0.5f);
    *cover = COVER_LAKE;
    if (w->grid->lake[row * ELEVATION_GRID_SIDE + column] && height < (float)GEOGRAPHY_LAKE_M)
        return (float)GEOGRAPHY_LAKE_M;
    *cover = COVER_GRASS;
    return height > LAND_MIN_M ? height : LAND_MIN_M;
}

static void fill_posts(struct weave *w, float *posts, uint8_t *cover)
{
    for (uint32_t row = 0; row < w->side; row++) {
        double z = (double)row * w->spacing_m;
        size_t first = (size_t)row * w->side;
        uint32_t node_row = (uint32_t)(z / ELEVATION_GRID_SPACING_M + ELEVATION_GRID_MARGIN + 0.5);
        weave_heights(w, z);
        weave_field(w, w->grid->inland, z, w->inland);
        weave_field(w, w->grid->roughness, z, w->roughness);
        weave_noise(w, NOISE_DETAIL, 430.0, 3, z);
        for (uint32_t i = 0; i < w->side; i++)
            posts[first + i] = place_post(w, i, node_row, &cover[first + i]);
    }
}

static double post_slope(const struct weave *w, const float *posts, uint32_t column, uint32_t row)
{
    uint32_t west = column > 0 ? column - 1 : 0, north = row > 0 ? row - 1 : 0;
    uint32_t east = column + 1 < w->side ? column + 1 : column;
    uint32_t south = row + 1 < w->side ? row + 1 : row;
    const float *line = posts + (size_t)row * w->side;
    float across = line[east] - line[west];
    float down = posts[(size_t)south * w->side + column] - posts[(size_t)north * w->side + column];
    double dx = (double)across / ((east - west) * w->spacing_m);
    double dz = (double)down / ((south - north) * w->spacing_m);
    return sqrt(dx * dx + dz * dz);
}

static enum cover land_cover(const struct weave *w, uint32_t i, double height, double slope)
{
    float edge = w->noise[i];
    if (w->inland[i] < 80.0f + 60.0f * edge && height < 15.0)
        return COVER_SAND;
    double bare = slope + 0.00018 * maths_max(height - 900.0, 0.0);
    if (bare > 0.80 + 0.25 * (double)edge)
        return COVER_ROCK;
    if (w->forest[i] + 0.22f * edge > 0.52f)
        return COVER_FOREST;
    return w->chaparral[i] + 0.20f * edge > 0.45f ? COVER_CHAPARRAL : COVER_GRASS;
}

static void fill_cover(struct weave *w, const float *posts, uint8_t *cover)
{
    for (uint32_t row = 0; row < w->side; row++) {
        double z = (double)row * w->spacing_m;
        size_t first = (size_t)row * w->side;
        weave_field(w, w->grid->inland, z, w->inland);
        weave_field(w, w->grid->forest, z, w->forest);
        weave_field(w, w->grid->chaparral, z, w->chaparral);
        weave_noise(w, NOISE_EDGE, 520.0, 3, z);
        for (uint32_t i = 0; i < w->side; i++) {
            if (cover_is_water(cover[first + i]))
                continue;
            double slope = post_slope(w, posts, i, row);
            cover[first + i] = (uint8_t)land_cover(w, i, (double)posts[first + i], slope);
        }
    }
}

/* Makes posts near a road road, if posts are dense enough to show one. */
static void pave(const struct weave *w, uint8_t *cover, const struct road_point *roads,
                 uint32_t count)
{
    if (w->spacing_m > ROAD_SPACING_M)
        return;
    for (uint32_t k = 0; k + 1 < count; k++) {
        double dx = roads[k + 1].x - roads[k].x;
        double dz = roads[k + 1].z - roads[k].z;
        if (roads[k].road != roads[k + 1].road)
            continue;
        int steps = (int)(sqrt(dx * dx + dz * dz) / (0.25 * w->spacing_m)) + 1;
        for (int i = 0; i <= steps; i++) {
            double x = roads[k].x + dx * i / steps, z = roads[k].z + dz * i / steps;
            double column = floor(x / w->spacing_m + 0.5), row = floor(z / w->spacing_m + 0.5);
            double off_x = x - column * w->spacing_m, off_z = z - row * w->spacing_m;
            uint8_t *at = &cover[(size_t)row * w->side + (size_t)column];
            if (off_x * off_x + off_z * off_z < ROAD_HALF_M * ROAD_HALF_M && !cover_is_water(*at))
                *at = COVER_ROAD;
        }
    }
}

int generate_hunter_liggett(float *posts, uint8_t *cover, uint32_t side, uint64_t seed,
                            struct road_point *roads, uint32_t road_max, uint32_t *road_count)
{
    struct elevation_grid grid;
    struct weave weave;
    int result = -1;
    *road_count = 0;
    seed = random_u64(
        seed, 0, 0, RANDOM_NOISE); /* noise functions add to the seed: seeds must not be adjacent */
    if (elevation_grid_build(&grid, seed) != 0)
        goto err_land;
    if (weave_init(&weave, &grid, side, seed) != 0)
        goto err_weave;
    fill_posts(&weave, posts, cover);
    fill_cover(&weave, posts, cover);
    result = generate_roads(&grid, roads, road_max, road_count);
    if (result == 0)
        pave(&weave, cover, roads, *road_count);
    weave_free(&weave);
err_weave:
    elevation_grid_free(&grid);
err_land:
    return result;
}
