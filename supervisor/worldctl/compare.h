/* Comparison of two frames, field by field. */
#ifndef JOLON_SUPERVISOR_WORLDCTL_COMPARE_H
#define JOLON_SUPERVISOR_WORLDCTL_COMPARE_H

#include "world/state.h"

#include <stdbool.h>
#include <stdint.h>

struct world;

/* One frame: the static world and the state. */
struct compared {
    const struct world *world;
    struct state state;
};

struct difference {
    char field[96];  /* "x of entity 41 \"alpha-1\" (row 40)" */
    char column[32]; /* "x" */
    uint64_t row;    /* or the number of the object, contact, crater or dent */
    char a[32], b[32];
    uint32_t columns; /* number of entity columns that differ */
};

/* Finds the first field that differs: first of the entities, column by column, then of the fixed
 * objects, the contacts, the craters, the dents and the head. Contacts are compared by their keys.
 * Covers everything that state_digest() covers, except the seed. Returns false if all is equal. */
bool compare_states(const struct compared *a, const struct compared *b,
                    struct difference *difference);

/* Finds the first parameter that makes the runs of two worlds differ: seed, time step, capacity,
 * table sizes. Returns false if there is none. */
bool compare_worlds(const struct world *a, const struct world *b, struct difference *difference);

#endif
