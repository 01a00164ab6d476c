/* Smooth fields from the tables of rivers, ridges and the coast. */
#include "world/making/elevation_fields.h"

#include "world/maths/maths.h"
#include "world/maths/noise.h"

#include <stdlib.h>

/* Lines of the tables are straight; real ones wind by up to a kilometre or two in six. */
#define WARP_M            2200.0
#define WARP_WAVELENGTH_M 6500.0
#define WARP_FREE_M       1300.0 /* near the places of known height they wind little */

/* The coast is better known than the rivers' bends. */
#define COAST_WARP 0.3

/* Least height of hills over the valleys beside them. */
#define RELIEF_MIN_M 60.0

enum { NOISE_WARP_X = 100, NOISE_WARP_Z = 200 };

static double square(double v)
{
    return v * v;
}

static void warp_node(struct elevation_fields *s, uint32_t node, double x, double z,
                      const struct anchor *anchors, uint64_t seed)
{
    double amount = WARP_M, u = x / WARP_WAVELENGTH_M, v = z / WARP_WAVELENGTH_M;
    for (int i = 0; i < GEOGRAPHY_PLACE_COUNT; i++) {
        double away = square(x - anchors[i].x) + square(z - anchors[i].z);
        amount *= away / (away + square(WARP_FREE_M));
    }
    s->warp_x[node] = (float)(amount * noise_fractal(seed + NOISE_WARP_X, u, v, 4));
    s->warp_z[node] = (float)(amount * noise_fractal(seed + NOISE_WARP_Z, u, v, 4));
}

/* Heights of several lines at a point, weighted by their nearness. */
struct blend {
    double nearest_m, weight, height;
};

static void blend_add(struct blend *blend, double distance_m, double height_m)
{
    double weight = 1.0 / square(square(distance_m) + square(150.0));
    blend->nearest_m = maths_min(blend->nearest_m, distance_m);
    blend->weight += weight;
    blend->height += weight * height_m;
}

/* Between the low lines (rivers, the coast) and the high ones (ridges) the height is interpolated
 * by the distances to both. */
static void draw_node(struct elevation_fields *s, uint32_t node, double x, double z)
{
    double wx = x + s->warp_x[node], wz = z + s->warp_z[node], beyond = INFINITY;
    struct blend low = {.nearest_m = INFINITY}, high = {.nearest_m = INFINITY};
    for (uint8_t i = 0; i < GEOGRAPHY_RIVER_COUNT; i++) {
        struct geography_near near = geography_nearest(&geography_rivers[i], wx, wz);
        double edge = near.distance_m - near.half_width_m;
        blend_add(&low, maths_max(edge, 0.0), near.height_m);
        if (edge < beyond) {
            beyond = edge;
            s->river[node] = i;
        }
    }
    double inland = geography_inland(x + COAST_WARP * (double)s->warp_x[node],
                                     z + COAST_WARP * (double)s->warp_z[node]);
    blend_add(&low, maths_max(inland, 0.0), 0.0);
    for (int i = 0; i < GEOGRAPHY_RIDGE_COUNT; i++) {
        struct geography_near near = geography_nearest(&geography_ridges[i], wx, wz);
        blend_add(&high, near.distance_m, near.height_m);
    }
    double foot = low.height / low.weight;
    double relief = maths_max(high.height / high.weight - foot, RELIEF_MIN_M);
    double share = low.nearest_m / (low.nearest_m + high.nearest_m + 1.0);
    s->envelope[node] = (float)(foot + relief * share);
    s->relief[node] = (float)relief;
    s->inland[node] = (float)inland;
    s->beyond[node] = (float)beyond;
}

int elevation_fields_build(struct elevation_fields *s,
                           const struct anchor anchors[GEOGRAPHY_PLACE_COUNT], uint64_t seed)
{
    *s = (struct elevation_fields){0};
    float **arrays[] = {&s->envelope, &s->relief, &s->inland, &s->beyond, &s->warp_x, &s->warp_z};
    s->river = malloc(ELEVATION_FIELDS_COUNT);
    int lacking = s->river == NULL;
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
        *arrays[i] = malloc(ELEVATION_FIELDS_COUNT * sizeof(float));
        lacking |= *arrays[i] == NULL;
    }
    if (lacking) {
        elevation_fields_free(s);
        return -1;
    }
    for (uint32_t node = 0; node < ELEVATION_FIELDS_COUNT; node++) {
        double x = elevation_grid_metres(node % ELEVATION_FIELDS_SIDE * ELEVATION_FIELDS_STEP);
        double z = elevation_grid_metres(node / ELEVATION_FIELDS_SIDE * ELEVATION_FIELDS_STEP);
        warp_node(s, node, x, z, anchors, seed);
        draw_node(s, node, x, z);
    }
    return 0;
}

void elevation_fields_free(struct elevation_fields *s)
{
    free(s->envelope);
    free(s->relief);
    free(s->inland);
    free(s->beyond);
    free(s->warp_x);
    free(s->warp_z);
    free(s->river);
    *s = (struct elevation_fields){0};
}

float elevation_fields_at(const float *field, uint32_t column, uint32_t row)
{
    uint32_t c = column / ELEVATION_FIELDS_STEP, r = row / ELEVATION_FIELDS_STEP;
    c = c > ELEVATION_FIELDS_SIDE - 2 ? ELEVATION_FIELDS_SIDE - 2 : c;
    r = r > ELEVATION_FIELDS_SIDE - 2 ? ELEVATION_FIELDS_SIDE - 2 : r;
    float u = (float)(column - c * ELEVATION_FIELDS_STEP) / (float)ELEVATION_FIELDS_STEP;
    float v = (float)(row - r * ELEVATION_FIELDS_STEP) / (float)ELEVATION_FIELDS_STEP;
    const float *p = field + r * ELEVATION_FIELDS_SIDE + c, *q = p + ELEVATION_FIELDS_SIDE;
    float north = p[0] + (p[1] - p[0]) * u, south = q[0] + (q[1] - q[0]) * u;
    return north + (south - north) * v;
}

void elevation_fields_blur(float *field, float *spare, int32_t radius)
{
    const int32_t side = ELEVATION_FIELDS_SIDE;
    for (int pass = 0; pass < 2; pass++) {
        const float *from = pass == 0 ? field : spare;
        float *to = pass == 0 ? spare : field;
        int32_t along = pass == 0 ? 1 : side, across = pass == 0 ? side : 1;
        for (int32_t line = 0; line < side; line++) {
            for (int32_t i = 0; i < side; i++) {
                float sum = 0.0f;
                for (int32_t k = i - radius; k <= i + radius; k++) {
                    int32_t at = k < 0 ? 0 : k >= side ? side - 1 : k;
                    sum += from[line * across + at * along];
                }
                to[line * across + i * along] = sum / (float)(2 * radius + 1);
            }
        }
    }
}
