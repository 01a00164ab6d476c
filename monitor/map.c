/* The map in characters. */
#include "monitor/map.h"

#include <string.h>

static char band(float height_m, float low_m, float high_m)
{
    static const char bands[] = MAP_BANDS;
    const int count = (int)sizeof bands - 1;
    if (!(high_m > low_m))
        return bands[0];
    int index = (int)((height_m - low_m) / (high_m - low_m) * (float)count);
    return bands[index < 0 ? 0 : index >= count ? count - 1 : index];
}

void map_ground(struct map *map, int rows, int columns, const float *height_m, const uint8_t *water,
                uint32_t side)
{
    map->rows = rows < 0 ? 0 : rows > MAP_ROWS_MAX ? MAP_ROWS_MAX : rows;
    map->columns = columns < 0 ? 0 : columns > MAP_COLUMNS_MAX ? MAP_COLUMNS_MAX : columns;
    memset(map->cell, ' ', sizeof map->cell);
    if (side == 0)
        return;
    float low_m = height_m[0], high_m = height_m[0];
    for (uint32_t i = 1; i < side * side; i++) {
        low_m = height_m[i] < low_m ? height_m[i] : low_m;
        high_m = height_m[i] > high_m ? height_m[i] : high_m;
    }
    for (int row = 0; row < map->rows; row++) {
        for (int column = 0; column < map->columns; column++) {
            uint32_t z = (uint32_t)(2 * row + 1) * side / (uint32_t)(2 * map->rows);
            uint32_t x = (uint32_t)(2 * column + 1) * side / (uint32_t)(2 * map->columns);
            uint32_t from = z * side + x;
            map->cell[row][column] = water[from] ? MAP_WATER : band(height_m[from], low_m, high_m);
        }
    }
}

/* 0 for the ground. */
static int rank(char cell)
{
    static const char ascending[] = {MAP_WRECK, MAP_NEUTRAL, MAP_RED,
                                     MAP_BLUE,  MAP_BOTH,    MAP_MUNITION};
    const char *found = memchr(ascending, cell, sizeof ascending);
    return found ? (int)(found - ascending) + 1 : 0;
}

void map_mark(struct map *map, double x, double z, double side_m, char mark)
{
    if (!(x >= 0.0 && x < side_m && z >= 0.0 && z < side_m))
        return;
    char *cell = &map->cell[(int)(z / side_m * map->rows)][(int)(x / side_m * map->columns)];
    if ((*cell == MAP_RED && mark == MAP_BLUE) || (*cell == MAP_BLUE && mark == MAP_RED))
        *cell = MAP_BOTH;
    else if (rank(mark) > rank(*cell))
        *cell = mark;
}
