/* Builds the elevation grid: coarse fields and noise determine where water flows, streams erode
 * valleys, and soil creep rounds the ground. */
#include "world/making/elevation_grid.h"

#include "world/making/stream_erosion.h"
#include "world/making/generate.h"
#include "world/making/plant_suitability.h"
#include "world/making/known_heights.h"
#include "world/maths/maths.h"
#include "world/maths/noise.h"
#include "world/making/elevation_fields.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The network of streams converges on every second node first, which takes a quarter of the time.
 * Its smaller branches are then found on all nodes. */
#define HALF_SIDE   ((ELEVATION_GRID_SIDE - 1) / 2 + 1)
#define HALF_ROUNDS 7
#define FULL_ROUNDS 3

/* The mean height of hills over their valley, as a share of the envelope's. */
#define MEAN_SHARE 0.88f

#define CREEP_PASSES 2

#define BEND_M 430.0

/* Depth of the sea. Only the slope at the shore is visible, where the ground between nodes meets
 * the water. */
#define SEA_BED_SLOPE 0.12f

enum {
    NOISE_RELIEF = 300,
    NOISE_HARDNESS = 400,
    NOISE_COVE = 500,
    NOISE_BREADTH = 600,
    NOISE_GULLY = 700,
    NOISE_BEND_EAST = 720,
    NOISE_BEND_SOUTH = 740,
};

struct builder {
    struct elevation_grid *grid;
    struct elevation_fields fields;
    struct stream_erosion half, full;
    struct anchor anchors[GEOGRAPHY_PLACE_COUNT];
    uint64_t seed;
    float *gain, *have,
        *spare; /* [ELEVATION_FIELDS_COUNT]; gain: factor of the ground's steepness */
};

/* Noises of one row of nodes. */
struct row_noise {
    float relief[ELEVATION_GRID_SIDE], hardness[ELEVATION_GRID_SIDE], cove[ELEVATION_GRID_SIDE],
        breadth[ELEVATION_GRID_SIDE];
};

static double square(double v)
{
    return v * v;
}

/* Returns 0 at or below 0, 1 at or above 1, and a smooth curve between. */
static double ramp(double t)
{
    t = maths_clamp(t, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

static void fill_row_noise(struct row_noise *noise, uint64_t seed, double z)
{
    struct noise_row row = {elevation_grid_metres(0), ELEVATION_GRID_SPACING_M, z,
                            ELEVATION_GRID_SIDE};
    *noise = (struct row_noise){0};
    noise_add_fractal_row(seed + NOISE_RELIEF, 4500.0, 1.0, 5, row, noise->relief);
    noise_add_fractal_row(seed + NOISE_HARDNESS, 2400.0, 1.0, 3, row, noise->hardness);
    noise_add_fractal_row(seed + NOISE_COVE, 2600.0, 1.0, 4, row, noise->cove);
    noise_add_fractal_row(seed + NOISE_BREADTH, 2900.0, 1.0, 4, row, noise->breadth);
}

/* On a node of a valley floor: sets the river's height, rising gently away from the river. */
static void lay_floor(struct builder *b, uint32_t node, double breadth)
{
    uint32_t column = node % ELEVATION_GRID_SIDE, row = node / ELEVATION_GRID_SIDE;
    double x = elevation_grid_metres(column) + elevation_fields_at(b->fields.warp_x, column, row);
    double z = elevation_grid_metres(row) + elevation_fields_at(b->fields.warp_z, column, row);
    uint32_t drawn =
        row / ELEVATION_FIELDS_STEP * ELEVATION_FIELDS_SIDE + column / ELEVATION_FIELDS_STEP;
    struct geography_near near = geography_nearest(&geography_rivers[b->fields.river[drawn]], x, z);
    /* Wide enough for the nodes of a river to be neighbours on the grid. */
    double half_width = maths_max(near.half_width_m * breadth, 0.72 * ELEVATION_GRID_SPACING_M);
    if (near.distance_m > half_width)
        return;
    double away = near.distance_m / half_width;
    double rise = 0.006 * near.distance_m + 0.004 * half_width * square(square(away));
    b->full.fixed[node] = 1;
    b->full.height[node] = (float)(near.height_m + rise);
    b->grid->plain[node] = (float)(1.0 - 0.5 * square(away));
}

static void lay_node(struct builder *b, uint32_t node, const struct row_noise *noise)
{
    struct stream_erosion *d = &b->full;
    uint32_t column = node % ELEVATION_GRID_SIDE, row = node / ELEVATION_GRID_SIDE;
    float envelope = elevation_fields_at(b->fields.envelope, column, row);
    float relief = elevation_fields_at(b->fields.relief, column, row);
    float inland = elevation_fields_at(b->fields.inland, column, row);
    float steep = (float)ramp((relief - 150.0) / 800.0), hardness = noise->hardness[column];
    float ground = envelope + (20.0f + 0.4f * relief) * noise->relief[column];
    d->height[node] = ground > 1.0f ? ground : 1.0f;
    d->steepness[node] = (60.0f + 140.0f * steep) * (1.0f + 0.5f * hardness);
    d->slope_max[node] = (0.34f + 0.36f * steep) * (1.0f + 0.2f * hardness);
    b->grid->inland[node] = inland + 420.0f * noise->cove[column];
    if (b->grid->inland[node] <= 0.0f) {
        d->fixed[node] = 1;
        d->height[node] = 0.0f;
    } else if (elevation_fields_at(b->fields.beyond, column, row) < 3000.0f) {
        lay_floor(b, node, 1.0 + 1.1 * (double)noise->breadth[column]);
    }
}

static void lay(struct builder *b)
{
    struct row_noise noise;
    for (uint32_t row = 0; row < ELEVATION_GRID_SIDE; row++) {
        fill_row_noise(&noise, b->seed, elevation_grid_metres(row));
        for (uint32_t column = 0; column < ELEVATION_GRID_SIDE; column++)
            lay_node(b, row * ELEVATION_GRID_SIDE + column, &noise);
    }
}

/* Takes every second node, and keeps rivers that run between them. */
static void lay_half(struct builder *b)
{
    const struct stream_erosion *full = &b->full;
    for (uint32_t node = 0; node < HALF_SIDE * HALF_SIDE; node++) {
        uint32_t column = 2 * (node % HALF_SIDE), row = 2 * (node / HALF_SIDE);
        uint32_t same = row * ELEVATION_GRID_SIDE + column;
        b->half.height[node] = full->height[same];
        b->half.steepness[node] = full->steepness[same];
        b->half.slope_max[node] = full->slope_max[same];
        b->half.fixed[node] = full->fixed[same];
        for (int k = 0; k < 9 && !full->fixed[same]; k++) {
            uint32_t c = column + (uint32_t)(k % 3) - 1, r = row + (uint32_t)(k / 3) - 1;
            if (c >= ELEVATION_GRID_SIDE || r >= ELEVATION_GRID_SIDE ||
                b->grid->plain[r * ELEVATION_GRID_SIDE + c] <= 0.0f)
                continue;
            b->half.fixed[node] = 1;
            b->half.height[node] = full->height[r * ELEVATION_GRID_SIDE + c];
            break;
        }
    }
}

/* Streams determine where hills are, the coarse fields their height. Makes the ground steeper where
 * hills of a kilometre or two came out lower than the coarse fields, and gentler where they came
 * out higher. step is 1 or 2 nodes of the elevation grid. */
static void calibrate(struct builder *b, struct stream_erosion *d, uint32_t step)
{
    float *want = b->gain, *have = b->have;
    uint32_t count = d->side * d->side;
    memset(want, 0, ELEVATION_FIELDS_COUNT * sizeof *want);
    memset(have, 0, ELEVATION_FIELDS_COUNT * sizeof *have);
    for (uint32_t node = 0; node < count; node++) {
        uint32_t column = node % d->side * step, row = node / d->side * step;
        uint32_t drawn =
            row / ELEVATION_FIELDS_STEP * ELEVATION_FIELDS_SIDE + column / ELEVATION_FIELDS_STEP;
        if (d->fixed[node])
            continue;
        float above = elevation_fields_at(b->fields.envelope, column, row) - d->base_m[node];
        want[drawn] += MEAN_SHARE * above > 8.0f ? MEAN_SHARE * above : 8.0f;
        have[drawn] += d->height[node] - d->base_m[node];
    }
    for (int pass = 0; pass < 2; pass++) {
        elevation_fields_blur(want, b->spare, 2);
        elevation_fields_blur(have, b->spare, 2);
    }
    for (uint32_t i = 0; i < ELEVATION_FIELDS_COUNT; i++)
        b->gain[i] = (float)maths_clamp((want[i] + 1.0f) / (have[i] + 1.0f), 0.5, 2.0);
    for (uint32_t node = 0; node < count; node++) {
        float gain = elevation_fields_at(b->gain, node % d->side * step, node / d->side * step);
        float slope_max = d->slope_max[node] * (0.5f + 0.5f * gain);
        d->steepness[node] *= gain;
        d->slope_max[node] = (float)maths_clamp(slope_max, 0.2, 0.95);
    }
}

static float between_halves(const float *field, uint32_t node)
{
    uint32_t column = node % ELEVATION_GRID_SIDE, row = node / ELEVATION_GRID_SIDE;
    uint32_t east = column & 1u, south = (row & 1u) * HALF_SIDE;
    const float *p = field + row / 2 * HALF_SIDE + column / 2;
    return 0.25f * (p[0] + p[east] + p[south] + p[south + east]);
}

/* Copies the result of the half grid to the full one, with noise for branches too fine for it. */
static void refine(struct builder *b)
{
    float gully[ELEVATION_GRID_SIDE];
    for (uint32_t row = 0; row < ELEVATION_GRID_SIDE; row++) {
        struct noise_row line = {elevation_grid_metres(0), ELEVATION_GRID_SPACING_M,
                                 elevation_grid_metres(row), ELEVATION_GRID_SIDE};
        memset(gully, 0, sizeof gully);
        noise_add_fractal_row(b->seed + NOISE_GULLY, 700.0, 1.0, 2, line, gully);
        for (uint32_t column = 0; column < ELEVATION_GRID_SIDE; column++) {
            uint32_t node = row * ELEVATION_GRID_SIDE + column;
            b->full.steepness[node] = between_halves(b->half.steepness, node);
            b->full.slope_max[node] = between_halves(b->half.slope_max, node);
            if (b->full.fixed[node])
                continue;
            float depth = 4.0f + 25.0f * b->full.slope_max[node];
            b->full.height[node] = between_halves(b->half.height, node) + depth * gully[column];
        }
    }
}

static void erode(struct builder *b)
{
    lay_half(b);
    for (uint64_t i = 0; i < HALF_ROUNDS; i++) {
        stream_erosion_round(&b->half, b->seed);
        calibrate(b, &b->half, 2);
    }
    refine(b);
    for (uint64_t i = 0; i < FULL_ROUNDS; i++) {
        stream_erosion_round(&b->full, b->seed);
        if (i + 1 < FULL_ROUNDS)
            calibrate(b, &b->full, 1);
    }
}

/* Soil creep: rounds crests and fills gullies, more where the hills are low. */
static void creep(struct builder *b)
{
    float *h = b->grid->height;
    float *p = b->full.height; /* of the previous pass */
    for (int pass = 0; pass < CREEP_PASSES; pass++) {
        memcpy(p, h, ELEVATION_GRID_COUNT * sizeof *h);
        for (uint32_t row = 1; row + 1 < ELEVATION_GRID_SIDE; row++) {
            for (uint32_t column = 1; column + 1 < ELEVATION_GRID_SIDE; column++) {
                uint32_t i = row * ELEVATION_GRID_SIDE + column, n = i - ELEVATION_GRID_SIDE,
                         s = i + ELEVATION_GRID_SIDE;
                float relief = elevation_fields_at(b->fields.relief, column, row);
                float rate = 0.55f - 0.3f * (float)ramp((relief - 200.0) / 900.0);
                float mean = (2.0f * (p[i - 1] + p[i + 1] + p[n] + p[s]) + p[n - 1] + p[n + 1] +
                              p[s - 1] + p[s + 1]) /
                             12.0f;
                if (b->grid->inland[i] > 0.0f)
                    h[i] += rate * (mean - p[i]);
            }
        }
    }
}

/* On a grid water flows along rows, columns and diagonals. Displaces the eroded heights by noise,
 * so that no valley is straight. */
static void bend(struct builder *b, const float *from, float *to)
{
    float east[ELEVATION_GRID_SIDE], south[ELEVATION_GRID_SIDE];
    for (uint32_t row = 0; row < ELEVATION_GRID_SIDE; row++) {
        double z = elevation_grid_metres(row);
        struct noise_row line = {elevation_grid_metres(0), ELEVATION_GRID_SPACING_M, z,
                                 ELEVATION_GRID_SIDE};
        memset(east, 0, sizeof east);
        memset(south, 0, sizeof south);
        noise_add_fractal_row(b->seed + NOISE_BEND_EAST, 1500.0, BEND_M, 3, line, east);
        noise_add_fractal_row(b->seed + NOISE_BEND_SOUTH, 1500.0, BEND_M, 3, line, south);
        for (uint32_t column = 0; column < ELEVATION_GRID_SIDE; column++)
            to[row * ELEVATION_GRID_SIDE + column] =
                (float)elevation_grid_at(from, elevation_grid_metres(column) + (double)east[column],
                                         z + (double)south[column]);
    }
}

/* Copies the other results of erosion beside the heights. */
static void take(struct builder *b)
{
    struct elevation_grid *grid = b->grid;
    for (uint32_t node = 0; node < ELEVATION_GRID_COUNT; node++) {
        double area_km2 = (double)b->full.area_m2[node] * 1e-6;
        /* The area is not needed any more: its memory is used again. */
        b->full.area_m2[node] = b->full.fixed[node] ? 0.0f : (float)(area_km2 / (area_km2 + 2.0));
    }
    bend(b, b->full.height, grid->height);
    bend(b, b->full.area_m2, grid->stream);
    creep(b);
    for (uint32_t node = 0; node < ELEVATION_GRID_COUNT; node++) {
        double east, south;
        if (grid->inland[node] <= 0.0f)
            grid->height[node] = SEA_BED_SLOPE * grid->inland[node];
        elevation_grid_gradient(grid, node, &east, &south);
        double slope = sqrt(east * east + south * south);
        grid->roughness[node] =
            (float)(maths_min(1.2 + 30.0 * slope, 11.0) * ramp(grid->inland[node] / 400.0));
    }
}

static int allocate(struct builder *b)
{
    struct elevation_grid *grid = b->grid;
    float **fields[] = {&grid->height, &grid->inland,    &grid->roughness, &grid->plain,
                        &grid->stream, &grid->chaparral, &grid->forest};
    int lacking = 0;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        *fields[i] = calloc(ELEVATION_GRID_COUNT, sizeof(float));
        lacking |= *fields[i] == NULL;
    }
    grid->lake = calloc(ELEVATION_GRID_COUNT, 1);
    b->gain = malloc(ELEVATION_FIELDS_COUNT * sizeof *b->gain);
    b->have = malloc(ELEVATION_FIELDS_COUNT * sizeof *b->have);
    b->spare = malloc(ELEVATION_FIELDS_COUNT * sizeof *b->spare);
    if (lacking || !grid->lake || !b->gain || !b->have || !b->spare ||
        stream_erosion_init(&b->half, HALF_SIDE, 2.0 * ELEVATION_GRID_SPACING_M) != 0 ||
        stream_erosion_init(&b->full, ELEVATION_GRID_SIDE, ELEVATION_GRID_SPACING_M) != 0)
        return -1;
    return elevation_fields_build(&b->fields, b->anchors, b->seed);
}

int elevation_grid_build(struct elevation_grid *grid, uint64_t seed)
{
    struct builder b = {.grid = grid, .seed = seed};
    *grid = (struct elevation_grid){0};
    for (int i = 0; i < GEOGRAPHY_PLACE_COUNT; i++) {
        const struct geography_place *place = &geography_places[i];
        b.anchors[i].height_m = place->height_m;
        b.anchors[i].peak = place->peak;
        generate_place(place->latitude_deg, place->longitude_deg, &b.anchors[i].x, &b.anchors[i].z);
    }
    int result = allocate(&b);
    if (result == 0) {
        lay(&b);
        erode(&b);
        take(&b);
        result = known_heights_set(grid, b.anchors);
    }
    if (result == 0)
        result = plant_suitability_fill(grid, seed);
    if (result != 0)
        elevation_grid_free(grid);
    stream_erosion_free(&b.half);
    stream_erosion_free(&b.full);
    elevation_fields_free(&b.fields);
    free(b.gain);
    free(b.have);
    free(b.spare);
    return result;
}

void elevation_grid_free(struct elevation_grid *grid)
{
    free(grid->height);
    free(grid->inland);
    free(grid->roughness);
    free(grid->plain);
    free(grid->stream);
    free(grid->chaparral);
    free(grid->forest);
    free(grid->lake);
    *grid = (struct elevation_grid){0};
}

double elevation_grid_at(const float *field, double x, double z)
{
    double u = maths_clamp(x / ELEVATION_GRID_SPACING_M + ELEVATION_GRID_MARGIN, 0.0,
                           ELEVATION_GRID_SIDE - 1.0);
    double v = maths_clamp(z / ELEVATION_GRID_SPACING_M + ELEVATION_GRID_MARGIN, 0.0,
                           ELEVATION_GRID_SIDE - 1.0);
    double c = floor(maths_min(u, ELEVATION_GRID_SIDE - 2.0)),
           r = floor(maths_min(v, ELEVATION_GRID_SIDE - 2.0));
    const float *p = field + (size_t)r * ELEVATION_GRID_SIDE + (size_t)c,
                *q = p + ELEVATION_GRID_SIDE;
    double north = p[0] + (double)(p[1] - p[0]) * (u - c);
    double south = q[0] + (double)(q[1] - q[0]) * (u - c);
    return north + (south - north) * (v - r);
}

void elevation_grid_gradient(const struct elevation_grid *grid, uint32_t node, double *east,
                             double *south)
{
    uint32_t column = node % ELEVATION_GRID_SIDE, row = node / ELEVATION_GRID_SIDE;
    uint32_t w = column > 0 ? node - 1 : node,
             e = column + 1 < ELEVATION_GRID_SIDE ? node + 1 : node;
    uint32_t n = row > 0 ? node - ELEVATION_GRID_SIDE : node;
    uint32_t s = row + 1 < ELEVATION_GRID_SIDE ? node + ELEVATION_GRID_SIDE : node;
    *east = (double)(grid->height[e] - grid->height[w]) / ((e - w) * ELEVATION_GRID_SPACING_M);
    *south = (double)(grid->height[s] - grid->height[n]) /
             ((double)((s - n) / ELEVATION_GRID_SIDE) * ELEVATION_GRID_SPACING_M);
}
