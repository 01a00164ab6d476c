/* Vegetation of the Santa Lucia Range: redwood and fir in the seaward canyons, pine on the heights,
 * chaparral on dry slopes, oaks along creeks and scattered in the valleys, grass inland. */
#include "world/making/plant_suitability.h"

#include "world/maths/maths.h"
#include "world/maths/noise.h"

#include <math.h>
#include <stdlib.h>

enum { NOISE_STAND = 800, NOISE_SAVANNA = 850, NOISE_BRUSH = 900 };

/* Noises of one row of nodes. */
struct row_noise {
    float stand[ELEVATION_GRID_SIDE], savanna[ELEVATION_GRID_SIDE], brush[ELEVATION_GRID_SIDE];
};

/* Returns 0 at or below 0, 1 at or above 1, and a smooth curve between. */
static double ramp(double t)
{
    t = maths_clamp(t, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/* Computes the mean slope around each node, which distinguishes hills from flats, since crests and
 * creek beds are level too. Running sums over rows into spare and over columns back, three
 * times. */
static void fill_hills(const struct elevation_grid *grid, float *hills, float *spare)
{
    const uint32_t reach = 2, width = 2 * reach + 1;
    for (uint32_t node = 0; node < ELEVATION_GRID_COUNT; node++) {
        double east, south;
        elevation_grid_gradient(grid, node, &east, &south);
        hills[node] = (float)sqrt(east * east + south * south);
    }
    for (int pass = 0; pass < 6; pass++) {
        const float *from = pass % 2 == 0 ? hills : spare;
        float *to = pass % 2 == 0 ? spare : hills;
        uint32_t along = pass % 2 == 0 ? 1 : ELEVATION_GRID_SIDE,
                 across = pass % 2 == 0 ? ELEVATION_GRID_SIDE : 1;
        for (uint32_t line = 0; line < ELEVATION_GRID_SIDE; line++) {
            const float *p = from + line * across;
            double sum = 0.0;
            for (uint32_t i = 0; i < ELEVATION_GRID_SIDE + reach; i++) {
                sum += i < ELEVATION_GRID_SIDE ? (double)p[i * along] : 0.0;
                sum -= i >= width ? (double)p[(i - width) * along] : 0.0;
                if (i >= reach)
                    to[line * across + (i - reach) * along] = (float)(sum / width);
            }
        }
    }
}

static void fill_node(struct elevation_grid *grid, uint32_t node, double hilliness,
                      const struct row_noise *noise)
{
    uint32_t column = node % ELEVATION_GRID_SIDE;
    double east, south, height = grid->height[node], inland = grid->inland[node];
    elevation_grid_gradient(grid, node, &east, &south);
    double slope = sqrt(east * east + south * south);
    /* Ground that rises to the south faces north, away from the sun. */
    double shade = maths_clamp((0.9 * south + 0.3 * east) / (slope + 0.06), -1.0, 1.0);
    double hill = ramp((hilliness - 0.03) / 0.09), high = ramp((height - 600.0) / 800.0);
    double dry = ramp((inland - 14000.0) / 24000.0), seaward = ramp((7000.0 - inland) / 5000.0);
    double creek = grid->stream[node], stand = noise->stand[column];
    double forest = 0.33 + 0.28 * shade + 0.45 * creek + 0.36 * high + 0.14 * seaward - 0.22 * dry +
                    0.46 * stand;
    double savanna = 0.33 + 0.55 * (double)noise->savanna[column] + 0.35 * creek +
                     0.12 * grid->plain[node] * (1.0 - dry) - 0.22 * dry;
    double brush = 0.42 + 0.30 * ramp((hilliness - 0.12) / 0.2) - 0.20 * shade - 0.24 * dry +
                   0.42 * (double)noise->brush[column] + 0.15 * high;
    grid->forest[node] = (float)maths_clamp(savanna + (forest - savanna) * hill, 0.0, 1.0);
    grid->chaparral[node] = (float)maths_clamp(brush * (0.25 + 0.75 * hill), 0.0, 1.0);
}

int plant_suitability_fill(struct elevation_grid *grid, uint64_t seed)
{
    float *hills = malloc(2u * ELEVATION_GRID_COUNT * sizeof *hills);
    if (!hills)
        return -1;
    fill_hills(grid, hills, hills + ELEVATION_GRID_COUNT);
    for (uint32_t row = 0; row < ELEVATION_GRID_SIDE; row++) {
        struct noise_row line = {elevation_grid_metres(0), ELEVATION_GRID_SPACING_M,
                                 elevation_grid_metres(row), ELEVATION_GRID_SIDE};
        struct row_noise noise = {0};
        noise_add_fractal_row(seed + NOISE_STAND, 2600.0, 1.0, 4, line, noise.stand);
        noise_add_fractal_row(seed + NOISE_SAVANNA, 1500.0, 1.0, 3, line, noise.savanna);
        noise_add_fractal_row(seed + NOISE_BRUSH, 2700.0, 1.0, 4, line, noise.brush);
        for (uint32_t column = 0; column < ELEVATION_GRID_SIDE; column++) {
            uint32_t node = row * ELEVATION_GRID_SIDE + column;
            fill_node(grid, node, (double)hills[node], &noise);
        }
    }
    free(hills);
    return 0;
}
