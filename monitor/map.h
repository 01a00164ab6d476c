/* The map: the ground and what moves on it in characters. North is up. Pure; knows neither DDS nor
 * the terminal. */
#ifndef JOLON_MONITOR_MAP_H
#define JOLON_MONITOR_MAP_H

#include <stdint.h>

#define MAP_ROWS_MAX    120
#define MAP_COLUMNS_MAX 240

/* Marks in ascending rank: the higher one shows where several share a cell. */
#define MAP_WRECK    'x'
#define MAP_NEUTRAL  'n'
#define MAP_RED      'r'
#define MAP_BLUE     'b'
#define MAP_BOTH     '%' /* red and blue in one cell */
#define MAP_MUNITION '*'

/* The ground: water, then four bands from the lowest land to the highest. */
#define MAP_WATER '~'
#define MAP_BANDS " .:^"

struct map {
    int rows, columns;
    char cell[MAP_ROWS_MAX][MAP_COLUMNS_MAX];
};

/* Begins a map of rows x columns characters (cut to the most there can be) with the ground of a
 * square grid of side x side heights [m]; water is 1 where a cell is. side 0: no ground. */
void map_ground(struct map *map, int rows, int columns, const float *height_m, const uint8_t *water,
                uint32_t side);

/* Puts a mark at (x, z) [m] of a square of side_m; what lies outside is left out. */
void map_mark(struct map *map, double x, double z, double side_m, char mark);

#endif
