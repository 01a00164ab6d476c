/* The cover of a ground: from rasters of classes through a table, or by slope and height. */
#ifndef JOLON_SUPERVISOR_GROUND_COVER_MAP_H
#define JOLON_SUPERVISOR_GROUND_COVER_MAP_H

#include "supervisor/ground/raster.h"
#include "world/terrain/terrain.h"

#define COVER_MAP_CLASSES 1000

/* What a class of a raster becomes. Values beyond enum cover: */
enum cover_map_rule {
    COVER_MAP_UNKNOWN = 100, /* the table has no row: a raster that has the class is refused */
    COVER_MAP_NONE,          /* the class says nothing; slope and height decide */
    COVER_MAP_WATER          /* sea within COVER_MAP_SEA_M of the sea level, else a lake */
};

#define COVER_MAP_SEA_M 1.0

struct cover_map_table {
    uint8_t rule[COVER_MAP_CLASSES]; /* enum cover or enum cover_map_rule */
};

/* Reads a table: a file, or the name of one of config/ground. 0, or -1 with the reason. */
int cover_map_table(struct cover_map_table *table, const char *name, struct error_text *error);

/* Fills cover [side * side] from the first raster that has a class there, or by slope and height
 * where none has. Posts of the sea get the height 0. *guessed: how many posts have no class. 0, or
 * -1 with the reason. */
int cover_map_fill(uint8_t *cover, float *posts, const struct post_grid *grid,
                   struct raster **rasters, uint32_t count, const struct cover_map_table *table,
                   uint64_t *guessed, struct error_text *error);

#endif
