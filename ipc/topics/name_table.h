/* The names that a world's scenario gave its vehicles, and the markings of remote ones, from the
 * topic EntityNames or from the world.
 *
 * A spawned vehicle has none. One thread at a time. */
#ifndef JOLON_IPC_TOPICS_NAME_TABLE_H
#define JOLON_IPC_TOPICS_NAME_TABLE_H

#include "status.h"

#include <stdbool.h>
#include <stdint.h>

struct entities;
struct world;

struct name_table {
    bool known; /* the names are known; there may be none */
    uint64_t run;
    uint32_t count;
    jolon_EntityName *entry; /* [count], by rising id */
};

/* Frees the names. A new table is all zeros. */
void name_table_close(struct name_table *names);

/* Replaces the names by a copy of these. Returns false without memory. */
bool name_table_copy(struct name_table *names, const jolon_EntityNames *sample);

/* Reads the names of a mapped world. run is the creation's number (header->made). If there are more
 * than jolon_NAMES_MAX, it takes the first. Returns false without memory. */
bool name_table_read_world(struct name_table *names, const struct world *world, uint64_t run);

/* Adds the markings of remote entities (world/entity/remote.h), as far as there is room for names.
 * Returns false without memory. */
bool name_table_add_markings(struct name_table *names, const struct entities *e, uint32_t used);

/* Returns the name of an entity, "" when it has none. */
const char *name_table_of(const struct name_table *names, uint32_t id);

/* Returns the id of the entity with this name, 0 when there is none. */
uint32_t name_table_find(const struct name_table *names, const char *name);

#endif
