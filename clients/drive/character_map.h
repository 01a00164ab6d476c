/* The map around the driven vehicle, of square cells of two characters. North is up. Pure.
 *
 * A vehicle is shown by two letters of its kind: lower case for blue, UPPER CASE for red,
 * Capitalised for neutral, so that the map needs no colours. */
#ifndef JOLON_CLIENTS_DRIVE_CHARACTER_MAP_H
#define JOLON_CLIENTS_DRIVE_CHARACTER_MAP_H

#include "ipc/topics/world_mirror.h"

#define CHARACTER_MAP_ROWS_MAX    64
#define CHARACTER_MAP_COLUMNS_MAX 96

enum character_map_mark {
    CHARACTER_MAP_GROUND,
    CHARACTER_MAP_WATER,
    CHARACTER_MAP_WRECK,
    CHARACTER_MAP_NEUTRAL,
    CHARACTER_MAP_RED,
    CHARACTER_MAP_BLUE,
    CHARACTER_MAP_MUNITION,
    CHARACTER_MAP_TARGET,
    CHARACTER_MAP_SELF
};

struct character_map {
    int rows, columns;
    double cell_m;
    struct character_map_cell {
        char text[3];
        uint8_t mark; /* enum character_map_mark */
    } cell[CHARACTER_MAP_ROWS_MAX][CHARACTER_MAP_COLUMNS_MAX];
};

/* Returns the side of a cell [m]. zoom 0: the nearest. */
double character_map_cell_m(uint32_t zoom);

/* Fills code[kinds] with two letters for each kind, which are different where that is possible. */
void character_map_codes(char code[][3], const struct world_mirror *mirror);

/* Draws the ground and the entities around self. target: id, 0: none. */
void character_map_draw(struct character_map *map, const struct world_mirror *mirror,
                        const jolon_Entity *self, uint32_t target, int rows, int columns,
                        double cell_m);

#endif
