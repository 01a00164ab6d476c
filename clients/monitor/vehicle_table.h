/* The table of vehicles: which of them are shown, in which order, and what a row says. Pure. */
#ifndef JOLON_CLIENTS_MONITOR_VEHICLE_TABLE_H
#define JOLON_CLIENTS_MONITOR_VEHICLE_TABLE_H

#include "ipc/topics/world_mirror.h"

#include <stdbool.h>
#include <stdint.h>

enum vehicle_table_column {
    VEHICLE_TABLE_ID,
    VEHICLE_TABLE_KIND,
    VEHICLE_TABLE_FORCE,
    VEHICLE_TABLE_BEHAVIOUR,
    VEHICLE_TABLE_DAMAGE,
    VEHICLE_TABLE_SPEED,
    VEHICLE_TABLE_HEADING,
    VEHICLE_TABLE_X,
    VEHICLE_TABLE_Z,
    VEHICLE_TABLE_ROUNDS,
    VEHICLE_TABLE_FUEL,
    VEHICLE_TABLE_COLUMNS
};

#define VEHICLE_TABLE_FILTER_MAX 64u
#define VEHICLE_TABLE_LINE_MAX   128u

struct vehicle_table {
    uint32_t *row; /* [count] index into the mirror's batch, in the order shown */
    uint32_t count, room;
};

const char *vehicle_table_column_name(enum vehicle_table_column column);

/* Does an entity suit a filter? Words, of which each must suit: part of its name, kind, force,
 * behaviour, damage or state, its id, or a comparison with a column of numbers as "speed>10" or
 * "rounds<5".
 * "" suits all. Munitions in flight suit none but "flight". */
bool vehicle_table_matches(const struct world_mirror *mirror, const jolon_Entity *entity,
                           const char *filter);

/* Fills the table anew from the mirror's batch; equal rows by their ids. False when there was no
 * memory: the table is empty then. */
bool vehicle_table_build(struct vehicle_table *table, const struct world_mirror *mirror,
                         const char *filter, enum vehicle_table_column sort, bool descending);
void vehicle_table_free(struct vehicle_table *table);

/* The place of an id in the table, table->count when it is not in it. */
uint32_t vehicle_table_find(const struct vehicle_table *table, const struct world_mirror *mirror,
                            uint32_t id);

/* The head, with an arrow at the column that is sorted by, and a row: 80 columns, and then the
 * name of a vehicle that has one. */
void vehicle_table_head(char line[VEHICLE_TABLE_LINE_MAX], enum vehicle_table_column sort,
                        bool descending);
void vehicle_table_line(char line[VEHICLE_TABLE_LINE_MAX], const struct world_mirror *mirror,
                        const jolon_Entity *entity);

#endif
