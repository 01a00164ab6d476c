/* Draws the map's characters. */
#include "clients/monitor/character_map.h"

#include <math.h>
#include <string.h>

static char band(double height_m, double low_m, double high_m)
{
    static const char bands[] = CHARACTER_MAP_BANDS;
    const int count = (int)sizeof bands - 1;
    if (!(high_m > low_m))
        return bands[0];
    int index = (int)((height_m - low_m) / (high_m - low_m) * (double)count);
    return bands[index < 0 ? 0 : index >= count ? count - 1 : index];
}

static uint32_t cell_of(double at, uint32_t side)
{
    return at <= 0.0 ? 0 : at >= (double)side ? side - 1 : (uint32_t)at;
}

/* The height interpolated between the centres of four cells. (x, z) is in cells from the
 * north-western corner. */
static double height_at(const struct character_map_ground *ground, double x, double z)
{
    uint32_t x0 = cell_of(x - 0.5, ground->side), z0 = cell_of(z - 0.5, ground->side);
    uint32_t x1 = cell_of(x + 0.5, ground->side), z1 = cell_of(z + 0.5, ground->side);
    double u = x1 > x0 ? x - 0.5 - (double)x0 : 0.0, v = z1 > z0 ? z - 0.5 - (double)z0 : 0.0;
    const float *north = ground->height_m + (size_t)z0 * ground->side;
    const float *south = ground->height_m + (size_t)z1 * ground->side;
    double a = (double)north[x0] + u * (double)(north[x1] - north[x0]);
    double b = (double)south[x0] + u * (double)(south[x1] - south[x0]);
    return a + v * (b - a);
}

static char ground_cell(const struct character_map_ground *ground, double x, double z, double low_m,
                        double high_m)
{
    if (!(x >= 0.0 && z >= 0.0 && x < ground->side_m && z < ground->side_m))
        return CHARACTER_MAP_BEYOND;
    double cells = (double)ground->side / ground->side_m;
    uint32_t column = cell_of(x * cells, ground->side), row = cell_of(z * cells, ground->side);
    if (ground->water[(size_t)row * ground->side + column])
        return CHARACTER_MAP_WATER;
    return band(height_at(ground, x * cells, z * cells), low_m, high_m);
}

void character_map_begin(struct character_map *map, int rows, int columns,
                         const struct character_map_area *area,
                         const struct character_map_ground *ground)
{
    map->rows = rows < 0 ? 0 : rows > CHARACTER_MAP_ROWS_MAX ? CHARACTER_MAP_ROWS_MAX : rows;
    map->columns = columns < 0                           ? 0
                   : columns > CHARACTER_MAP_COLUMNS_MAX ? CHARACTER_MAP_COLUMNS_MAX
                                                         : columns;
    map->m_per_column = area->across_m / (double)(map->columns > 0 ? map->columns : 1);
    double down_m = map->m_per_column * CHARACTER_MAP_COLUMNS_A_ROW;
    map->x0 = area->x - 0.5 * area->across_m;
    map->z0 = area->z - 0.5 * down_m * (double)map->rows;
    memset(map->cell, ' ', sizeof map->cell);
    if (ground->side == 0)
        return;
    double low_m = (double)ground->height_m[0], high_m = low_m;
    for (uint32_t i = 1; i < ground->side * ground->side; i++) {
        low_m = fmin(low_m, (double)ground->height_m[i]);
        high_m = fmax(high_m, (double)ground->height_m[i]);
    }
    for (int row = 0; row < map->rows; row++) {
        for (int column = 0; column < map->columns; column++)
            map->cell[row][column] =
                ground_cell(ground, map->x0 + ((double)column + 0.5) * map->m_per_column,
                            map->z0 + ((double)row + 0.5) * down_m, low_m, high_m);
    }
}

/* The rank of a mark, from 1; 0 for the ground. */
static int rank(char cell)
{
    static const char ascending[] = {
        CHARACTER_MAP_WRECK, CHARACTER_MAP_NEUTRAL,  CHARACTER_MAP_RED,     CHARACTER_MAP_BLUE,
        CHARACTER_MAP_BOTH,  CHARACTER_MAP_MUNITION, CHARACTER_MAP_SELECTED};
    const char *found = memchr(ascending, cell, sizeof ascending);
    return found ? (int)(found - ascending) + 1 : 0;
}

void character_map_mark(struct character_map *map, double x, double z, char mark)
{
    double column = (x - map->x0) / map->m_per_column;
    double row = (z - map->z0) / (map->m_per_column * CHARACTER_MAP_COLUMNS_A_ROW);
    if (!(column >= 0.0 && row >= 0.0 && column < (double)map->columns && row < (double)map->rows))
        return;
    char *cell = &map->cell[(int)row][(int)column];
    if ((*cell == CHARACTER_MAP_RED && mark == CHARACTER_MAP_BLUE) ||
        (*cell == CHARACTER_MAP_BLUE && mark == CHARACTER_MAP_RED))
        *cell = CHARACTER_MAP_BOTH;
    else if (rank(mark) > rank(*cell))
        *cell = mark;
}
