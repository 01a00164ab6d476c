/* The map of the ground and the entities in characters. North is up. Pure: it uses neither DDS nor
 * the terminal. */
#ifndef JOLON_CLIENTS_MONITOR_CHARACTER_MAP_H
#define JOLON_CLIENTS_MONITOR_CHARACTER_MAP_H

#include <stdint.h>

#define CHARACTER_MAP_ROWS_MAX    120
#define CHARACTER_MAP_COLUMNS_MAX 480

/* A character is about twice as high as wide. */
#define CHARACTER_MAP_COLUMNS_A_ROW 2

/* Marks in ascending rank: a cell shows the highest of its marks. */
#define CHARACTER_MAP_WRECK    'x'
#define CHARACTER_MAP_NEUTRAL  'n'
#define CHARACTER_MAP_RED      'r'
#define CHARACTER_MAP_BLUE     'b'
#define CHARACTER_MAP_BOTH     '%' /* red and blue in one cell */
#define CHARACTER_MAP_MUNITION '*'
#define CHARACTER_MAP_SELECTED '@'

/* The ground: water, four bands of height from the lowest to the highest, and outside the world. */
#define CHARACTER_MAP_WATER  '~'
#define CHARACTER_MAP_BANDS  " .:^"
#define CHARACTER_MAP_BEYOND '\''

/* The ground: a square of side_m in side x side cells, row by row from the north-west. A cell has a
 * height [m], and water is 1 if it is water. side 0: no ground is known. */
struct character_map_ground {
    const float *height_m;
    const uint8_t *water;
    uint32_t side;
    double side_m;
};

/* The part of the world that is shown. */
struct character_map_area {
    double x, z;     /* [m] its centre */
    double across_m; /* from the western to the eastern edge, above 0 */
};

struct character_map {
    int rows, columns;
    double x0, z0;       /* [m] of the north-western corner */
    double m_per_column; /* a row shows CHARACTER_MAP_COLUMNS_A_ROW times as much */
    char cell[CHARACTER_MAP_ROWS_MAX][CHARACTER_MAP_COLUMNS_MAX];
};

/* Begins a map of an area with rows x columns characters, limited to the maximum, and draws the
 * ground. Heights between the centres of the ground's cells are interpolated. */
void character_map_begin(struct character_map *map, int rows, int columns,
                         const struct character_map_area *area,
                         const struct character_map_ground *ground);

/* Puts a mark at (x, z) [m]; outside the map it does nothing. */
void character_map_mark(struct character_map *map, double x, double z, char mark);

#endif
