/* Value noise along rows of texels. */
#include "renderer/scene/noise/value_noise_rows.h"

#include "renderer/scene/noise/value_noise.h"

#include <string.h>

static float smooth(float t)
{
    return t * t * (3.0f - 2.0f * t);
}

void value_noise_rows_begin(struct value_noise_rows *rows, double wavelength_m, uint32_t seed,
                            double x, double step_m, uint32_t columns)
{
    float held = (float)(wavelength_m / step_m) * 0.5f - 0.5f;
    rows->wavelength_m = wavelength_m;
    rows->seed = seed;
    rows->columns = columns;
    rows->held = held < 0.0f ? 0.0f : held > 1.0f ? 1.0f : held;
    rows->north = INT32_MIN;
    if (rows->held == 0.0f)
        return;
    rows->west = value_noise_floor(x / wavelength_m);
    for (uint32_t i = 0; i < columns; i++) {
        double place = (x + i * step_m) / wavelength_m;
        int32_t whole = value_noise_floor(place);
        rows->at[i] = whole - rows->west;
        rows->past[i] = smooth((float)(place - whole));
    }
    rows->nodes = (uint32_t)rows->at[columns - 1] + 2;
}

static void hash_nodes(const struct value_noise_rows *rows, int32_t z, float *nodes)
{
    for (uint32_t i = 0; i < rows->nodes; i++)
        nodes[i] = 2.0f * value_noise_unit(rows->west + (int32_t)i, z, rows->seed) - 1.0f;
}

void value_noise_rows_add(struct value_noise_rows *rows, double z, float scale, float *row)
{
    if (rows->held == 0.0f)
        return;
    double place = z / rows->wavelength_m;
    int32_t north = value_noise_floor(place);
    float past = smooth((float)(place - north));
    if (north != rows->north) {
        if (north - 1 == rows->north)
            memcpy(rows->nodes_north, rows->nodes_south, sizeof rows->nodes_north);
        else
            hash_nodes(rows, north, rows->nodes_north);
        hash_nodes(rows, north + 1, rows->nodes_south);
        rows->north = north;
    }
    float nodes[VALUE_NOISE_COLUMNS_MAX + 3], much = scale * rows->held;
    for (uint32_t i = 0; i < rows->nodes; i++)
        nodes[i] =
            much * (rows->nodes_north[i] + (rows->nodes_south[i] - rows->nodes_north[i]) * past);
    for (uint32_t i = 0; i < rows->columns; i++) {
        const float *node = nodes + rows->at[i];
        row[i] += node[0] + (node[1] - node[0]) * rows->past[i];
    }
}
