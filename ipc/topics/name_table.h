/* What a world's vehicles are called: the names that its scenario gave them, by EntityNames.
 *
 * A vehicle that was spawned has none. One thread at a time. */
#ifndef JOLON_IPC_TOPICS_NAME_TABLE_H
#define JOLON_IPC_TOPICS_NAME_TABLE_H

#include "status.h"

#include <stdbool.h>
#include <stdint.h>

struct world;

struct name_table {
    bool told; /* the names are here; there may be none */
    uint64_t run;
    uint32_t count;
    jolon_EntityName *entry; /* [count], by rising id */
};

/* Frees the names; begin with zeros. */
void name_table_close(struct name_table *names);

/* Takes these names for those of the world, in place of what there was; false: no memory. */
bool name_table_learn(struct name_table *names, const jolon_EntityNames *told);

/* Reads the names of a mapped world, of which `run` is the creation's number (header->made). Of
 * more than jolon_NAMES_MAX it takes the first. false: no memory. */
bool name_table_read_world(struct name_table *names, const struct world *world, uint64_t run);

/* The name of an entity, "" when it has none. */
const char *name_table_of(const struct name_table *names, uint32_t id);

/* Who is called so, 0 when nobody is. */
uint32_t name_table_find(const struct name_table *names, const char *name);

#endif
