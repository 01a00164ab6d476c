/* What a world's vehicles are called: the names that its scenario gave them, by EntityNames.
 *
 * A vehicle that was spawned has none. One thread at a time. */
#ifndef JOLON_TOPICS_NAMES_H
#define JOLON_TOPICS_NAMES_H

#include "status.h"

#include <stdbool.h>
#include <stdint.h>

struct world;

struct names {
    bool told; /* the names are here; there may be none */
    uint64_t run;
    uint32_t count;
    jolon_EntityName *entry; /* [count], by rising id */
};

/* Frees the names; begin with zeros. */
void names_close(struct names *names);

/* Takes these names for those of the world, in place of what there was; false: no memory. */
bool names_learn(struct names *names, const jolon_EntityNames *told);

/* Reads the names of a mapped world, of which `run` is the creation's number (header->made). Of
 * more than jolon_NAMES_MAX it takes the first. false: no memory. */
bool names_read_world(struct names *names, const struct world *world, uint64_t run);

/* The name of an entity, "" when it has none. */
const char *names_of(const struct names *names, uint32_t id);

/* Who is called so, 0 when nobody is. */
uint32_t names_find(const struct names *names, const char *name);

#endif
