/* The table of vehicles: which of them are shown, in which order, and what a row says. Pure. */
#ifndef JOLON_MONITOR_TABLE_H
#define JOLON_MONITOR_TABLE_H

#include "topics/mirror.h"

#include <stdbool.h>
#include <stdint.h>

enum table_column {
    TABLE_ID,
    TABLE_KIND,
    TABLE_FORCE,
    TABLE_BEHAVIOUR,
    TABLE_DAMAGE,
    TABLE_SPEED,
    TABLE_HEADING,
    TABLE_X,
    TABLE_Z,
    TABLE_ROUNDS,
    TABLE_FUEL,
    TABLE_COLUMNS
};

#define TABLE_FILTER_MAX 64u
#define TABLE_LINE_MAX   128u

struct table {
    uint32_t *row; /* [count] index into the mirror's batch, in the order shown */
    uint32_t count, room;
};

const char *table_column_name(enum table_column column);

/* Does an entity suit a filter? Words, of which each must suit: part of its name, kind, force,
 * behaviour, damage or state, its id, or a comparison with a column of numbers as "speed>10" or
 * "rounds<5".
 * "" suits all. Munitions in flight suit none but "flight". */
bool table_suits(const struct mirror *mirror, const jolon_Entity *entity, const char *filter);

/* Fills the table anew from the mirror's batch; equal rows by their ids. False when there was no
 * memory: the table is empty then. */
bool table_build(struct table *table, const struct mirror *mirror, const char *filter,
                 enum table_column sort, bool descending);
void table_free(struct table *table);

/* The place of an id in the table, table->count when it is not in it. */
uint32_t table_find(const struct table *table, const struct mirror *mirror, uint32_t id);

/* The head, with an arrow at the column that is sorted by, and a row: 80 columns, and then the
 * name of a vehicle that has one. */
void table_head(char line[TABLE_LINE_MAX], enum table_column sort, bool descending);
void table_line(char line[TABLE_LINE_MAX], const struct mirror *mirror, const jolon_Entity *entity);

#endif
