/* The map: the ground and what moves on it in characters. North is up. Pure; knows neither DDS nor
 * the terminal. */
#ifndef JOLON_CLIENTS_MONITOR_CHARACTER_MAP_H
#define JOLON_CLIENTS_MONITOR_CHARACTER_MAP_H

#include <stdint.h>

#define CHARACTER_MAP_ROWS_MAX    120
#define CHARACTER_MAP_COLUMNS_MAX 480

/* A character is about twice as high as wide. */
#define CHARACTER_MAP_COLUMNS_A_ROW 2

/* Marks in ascending rank: the higher one shows where several share a cell. */
#define CHARACTER_MAP_WRECK    'x'
#define CHARACTER_MAP_NEUTRAL  'n'
#define CHARACTER_MAP_RED      'r'
#define CHARACTER_MAP_BLUE     'b'
#define CHARACTER_MAP_BOTH     '%' /* red and blue in one cell */
#define CHARACTER_MAP_MUNITION '*'
#define CHARACTER_MAP_SELECTED '@' /* the one that is looked at */

/* The ground: water, then four bands from the lowest land to the highest, and beyond the world. */
#define CHARACTER_MAP_WATER  '~'
#define CHARACTER_MAP_BANDS  " .:^"
#define CHARACTER_MAP_BEYOND '\''

/* What there is of the ground: side x side heights [m] of cells of a square of side_m, row by row
 * from the north-west; water is 1 where a cell is. side 0: nothing. */
struct character_map_ground {
    const float *height_m;
    const uint8_t *water;
    uint32_t side;
    double side_m;
};

/* The part of the world that is shown. */
struct character_map_area {
    double x, z;     /* [m] its middle */
    double across_m; /* from its western to its eastern edge, above 0 */
};

struct character_map {
    int rows, columns;
    double x0, z0;       /* [m] of the north-western corner */
    double m_per_column; /* a row shows CHARACTER_MAP_COLUMNS_A_ROW times as much */
    char cell[CHARACTER_MAP_ROWS_MAX][CHARACTER_MAP_COLUMNS_MAX];
};

/* Begins a map of rows x columns characters (cut to the most there can be) of an area, with the
 * ground, whose heights between the cells' middles are interpolated. */
void character_map_begin(struct character_map *map, int rows, int columns,
                         const struct character_map_area *area,
                         const struct character_map_ground *ground);

/* Puts a mark at (x, z) [m]; what lies outside is left out. */
void character_map_mark(struct character_map *map, double x, double z, char mark);

#endif
