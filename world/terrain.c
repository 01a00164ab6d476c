/* Heights, normals and cover of the ground. */
#include "world/terrain.h"

#include "world/clones.h"

#include <stddef.h>

/* The cell's column or row and how far into it, 0..1; outside the square the edge. Without
 * branches: where a vehicle stands no processor can guess. */
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

static inline double base_height(const struct terrain *terrain, double x, double z)
{
    double u, v;
    uint32_t column = cell_of(terrain, x, &u);
    uint32_t row = cell_of(terrain, z, &v);
    const float *north = terrain->posts + (size_t)row * terrain->side + column;
    /* The edges of the triangle: north and east of the diagonal, or south and west of it. */
    size_t north_east = u >= v;
    const float *across = north + (1 - north_east) * terrain->side;
    const float *down = north + north_east;
    return (double)north[0] + ((double)across[1] - (double)across[0]) * u +
           ((double)down[terrain->side] - (double)down[0]) * v;
}

double terrain_base_height(const struct terrain *terrain, double x, double z)
{
    return base_height(terrain, x, z);
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
    double height = base_height(terrain, x, z);
    return craters ? height + crater_offset(craters, x, z) : height;
}

/* Four points at once: the same operations in the same order as base_height() does them. */
typedef double four __attribute__((vector_size(4 * sizeof(double))));
typedef int64_t four_masks __attribute__((vector_size(4 * sizeof(int64_t))));
typedef int32_t four_cells __attribute__((vector_size(4 * sizeof(int32_t))));

#define CHOOSE(mask, yes, no) ((four)(((mask) & (four_masks)(yes)) | (~(mask) & (four_masks)(no))))
#define EVERY(value)          ((four){(value), (value), (value), (value)})

VECTOR_CLONES
void terrain_heights(const struct terrain *terrain, const struct crater_index *craters,
                     const double x[TERRAIN_POINTS], const double z[TERRAIN_POINTS],
                     double height[TERRAIN_POINTS])
{
    const four spacing = EVERY(terrain->spacing_m), none = EVERY(0.0);
    const four last = EVERY((double)(terrain->side - 2)), end = last + 1.0;
    four u = (four){x[0], x[1], x[2], x[3]} / spacing, v = (four){z[0], z[1], z[2], z[3]} / spacing;
    u = CHOOSE(u > none, u, none);
    v = CHOOSE(v > none, v, none);
    u = CHOOSE(u < end, u, end);
    v = CHOOSE(v < end, v, end);
    four_cells column = __builtin_convertvector(CHOOSE(u < last, u, last), four_cells);
    four_cells row = __builtin_convertvector(CHOOSE(v < last, v, last), four_cells);
    u -= __builtin_convertvector(column, four);
    v -= __builtin_convertvector(row, four);
    four_masks north_east = u >= v;
    double nw[TERRAIN_POINTS], se[TERRAIN_POINTS], third[TERRAIN_POINTS];
    for (int i = 0; i < TERRAIN_POINTS; i++) {
        const float *post =
            terrain->posts + (size_t)(uint32_t)row[i] * terrain->side + (uint32_t)column[i];
        nw[i] = (double)post[0];
        se[i] = (double)post[terrain->side + 1];
        third[i] = (double)post[north_east[i] ? 1 : terrain->side];
    }
    four corner = {third[0], third[1], third[2], third[3]};
    four from = {nw[0], nw[1], nw[2], nw[3]}, to = {se[0], se[1], se[2], se[3]};
    four first = corner - from, second = to - corner;
    four heights =
        from + CHOOSE(north_east, first, second) * u + CHOOSE(north_east, second, first) * v;
    for (int i = 0; i < TERRAIN_POINTS; i++)
        height[i] = heights[i];
    for (int i = 0; craters && craters->count > 0 && i < TERRAIN_POINTS; i++)
        height[i] += crater_offset(craters, x[i], z[i]);
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
