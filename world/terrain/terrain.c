/* Heights, normals and cover of the ground. */
#include "world/terrain/terrain.h"

#include <stddef.h>

/* Returns the cell's column or row and the position in it, 0..1; outside the square those of the
 * edge. Without branches, since they cannot be predicted. */
static inline uint32_t cell_of(const struct terrain *terrain, double metres, double *fraction)
{
    uint32_t last = terrain->side - 2;
    double cells = maths_max(metres / terrain->spacing_m, 0.0);
    cells = maths_min(cells, (double)last + 1.0);
    uint32_t cell = (uint32_t)cells;
    cell = cell < last ? cell : last;
    *fraction = cells - (double)cell;
    return cell;
}

void terrain_prefetch(const struct terrain *terrain, double x, double z)
{
    double u, v;
    const float *north =
        terrain->posts + (size_t)cell_of(terrain, z, &v) * terrain->side + cell_of(terrain, x, &u);
    __builtin_prefetch(north);
    __builtin_prefetch(north + terrain->side);
}

/* Returns the height, and how much it rises over a cell to the east and to the south. */
static inline double base_plane(const struct terrain *terrain, double x, double z, double *east,
                                double *south)
{
    double u, v;
    uint32_t column = cell_of(terrain, x, &u);
    uint32_t row = cell_of(terrain, z, &v);
    const float *north = terrain->posts + (size_t)row * terrain->side + column;
    /* The edges of the triangle: north and east of the diagonal, or south and west of it. */
    size_t north_east = u >= v;
    const float *across = north + (1 - north_east) * terrain->side;
    const float *down = north + north_east;
    *east = (double)across[1] - (double)across[0];
    *south = (double)down[terrain->side] - (double)down[0];
    return (double)north[0] + *east * u + *south * v;
}

static inline double base_height(const struct terrain *terrain, double x, double z)
{
    double east, south;
    return base_plane(terrain, x, z, &east, &south);
}

double terrain_base_height(const struct terrain *terrain, double x, double z)
{
    double height = base_height(terrain, x, z);
    return terrain->earthworks.count > 0 ? height + earthwork_offset(&terrain->earthworks, x, z)
                                         : height;
}

double terrain_base_plane(const struct terrain *terrain, double x, double z, double *east,
                          double *south)
{
    double height = base_plane(terrain, x, z, east, south);
    *east /= terrain->spacing_m;
    *south /= terrain->spacing_m;
    return height;
}

double terrain_height(const struct terrain *terrain, const struct crater_index *craters, double x,
                      double z)
{
    double height = terrain_base_height(terrain, x, z);
    return craters ? height + crater_offset(craters, x, z) : height;
}

bool terrain_uneven_near(const struct terrain *terrain, const struct crater_index *craters,
                         double x, double z, double reach_m)
{
    return earthwork_near(&terrain->earthworks, x, z, reach_m) ||
           (craters && crater_index_near(craters, x, z, reach_m));
}

double terrain_lift(const struct terrain *terrain, const struct crater_index *craters,
                    const struct crater_footing *footing)
{
    double offset[3][3];
    if (terrain->earthworks.count == 0)
        return craters ? crater_lift(craters, footing) : 0.0;
    for (int i = 0; i < 9; i++) {
        double x, z;
        crater_footing_point(footing, i / 3 - 1, i % 3 - 1, &x, &z);
        offset[i / 3][i % 3] = earthwork_offset(&terrain->earthworks, x, z) +
                               (craters ? crater_offset(craters, x, z) : 0.0);
    }
    return crater_footing_lift(offset);
}

double terrain_water_depth(const struct terrain *terrain, double x, double z)
{
    return earthwork_water(&terrain->earthworks, x, z);
}

struct terrain_posts terrain_posts(const struct terrain *terrain, double from_m, double metres)
{
    uint32_t most = terrain->side - 1, first = (uint32_t)(from_m / terrain->spacing_m);
    uint32_t last = (uint32_t)((from_m + metres) / terrain->spacing_m) + 1;
    return (struct terrain_posts){first < most ? first : most, last < most ? last : most};
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
