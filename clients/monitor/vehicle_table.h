/* The table of vehicles: filtering, sorting and the text of the rows. Pure. */
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

/* Returns true if the entity matches each word of the filter. A word is a part of the name, kind,
 * force, behaviour, damage or state, the id, or a comparison with a column of numbers like
 * "speed>10" or "rnds<5". Munitions in flight match only if a word is "flight". */
bool vehicle_table_matches(const struct world_mirror *mirror, const jolon_Entity *entity,
                           const char *filter);

/* Fills the table from the mirror's batch. Rows that are equal in the sorted column are sorted by
 * id. Returns false, with an empty table, if there is no memory. */
bool vehicle_table_build(struct vehicle_table *table, const struct world_mirror *mirror,
                         const char *filter, enum vehicle_table_column sort, bool descending);
void vehicle_table_free(struct vehicle_table *table);

/* Returns the row of an id, or table->count if it is not in the table. */
uint32_t vehicle_table_find(const struct vehicle_table *table, const struct world_mirror *mirror,
                            uint32_t id);

/* The head, with an arrow at the sorted column, and a row: 80 columns, then the vehicle's name. */
void vehicle_table_head(char line[VEHICLE_TABLE_LINE_MAX], enum vehicle_table_column sort,
                        bool descending);
void vehicle_table_line(char line[VEHICLE_TABLE_LINE_MAX], const struct world_mirror *mirror,
                        const jolon_Entity *entity);

#endif
