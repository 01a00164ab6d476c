/* Heights, normals and cover of the ground. */
#include "world/terrain.h"

#include <stddef.h>

/* The cell's column or row and how far into it, 0..1; outside the square the edge. */
static uint32_t cell_of(const struct terrain *terrain, double metres, double *fraction)
{
    double cells = metres / terrain->spacing_m;
    uint32_t last = terrain->side - 2;
    if (!(cells > 0.0)) {
        *fraction = 0.0;
        return 0;
    }
    if (cells >= (double)last + 1.0) {
        *fraction = 1.0;
        return last;
    }
    uint32_t cell = (uint32_t)cells;
    *fraction = cells - (double)cell;
    return cell;
}

double terrain_base_height(const struct terrain *terrain, double x, double z)
{
    double u, v;
    uint32_t column = cell_of(terrain, x, &u);
    uint32_t row = cell_of(terrain, z, &v);
    const float *north = terrain->posts + (size_t)row * terrain->side + column;
    const float *south = north + terrain->side;
    double nw = (double)north[0], ne = (double)north[1];
    double sw = (double)south[0], se = (double)south[1];
    if (u >= v) /* north-east triangle */
        return nw + (ne - nw) * u + (se - ne) * v;
    return nw + (se - sw) * u + (sw - nw) * v;
}

void terrain_prefetch(const struct terrain *terrain, double x, double z)
{
    double u, v;
    size_t post = (size_t)cell_of(terrain, z, &v) * terrain->side + cell_of(terrain, x, &u);
    __builtin_prefetch(terrain->posts + post);
    __builtin_prefetch(terrain->posts + post + terrain->side);
    __builtin_prefetch(terrain->cover + post);
    __builtin_prefetch(terrain->cover + post + terrain->side);
}

double terrain_height(const struct terrain *terrain, const struct crater_index *craters, double x,
                      double z)
{
    double height = terrain_base_height(terrain, x, z);
    return craters ? height + crater_offset(craters, x, z) : height;
}

struct vec3 terrain_normal(const struct terrain *terrain, const struct crater_index *craters,
                           double x, double z)
{
    double west = terrain_height(terrain, craters, x - 0.5, z);
    double east = terrain_height(terrain, craters, x + 0.5, z);
    double north = terrain_height(terrain, craters, x, z - 0.5);
    double south = terrain_height(terrain, craters, x, z + 0.5);
    struct vec3 n = {west - east, 1.0, north - south};
    return vec3_scale(n, 1.0 / vec3_length(n));
}

enum cover terrain_cover(const struct terrain *terrain, double x, double z)
{
    double u, v;
    uint32_t column = cell_of(terrain, x, &u) + (u >= 0.5);
    uint32_t row = cell_of(terrain, z, &v) + (v >= 0.5);
    return (enum cover)terrain->cover[(size_t)row * terrain->side + column];
}
