/* Comparing two frames, field by field. */
#ifndef JOLON_SUPERVISOR_WORLDCTL_COMPARE_H
#define JOLON_SUPERVISOR_WORLDCTL_COMPARE_H

#include "world/state.h"

#include <stdbool.h>
#include <stdint.h>

struct world;

/* One frame: what never changes and what does. */
struct compared {
    const struct world *world;
    struct state state;
};

struct difference {
    char field[96];  /* "x of entity 41 \"alpha-1\" (row 40)" */
    char column[32]; /* "x" */
    uint64_t row;    /* or the object's, crater's, dent's number */
    char a[32], b[32];
    uint32_t columns; /* of the entities that differ somewhere */
};

/* The first field that differs: of the entities column by column, then of the fixed objects, the
 * craters, the dents and the head. Everything that state_digest() is taken over but the seed.
 * False when all is equal. */
bool compare_states(const struct compared *a, const struct compared *b,
                    struct difference *difference);

/* The first parameter that makes two worlds another run each: seed, step of time, capacity, size of
 * their tables. False when there is none. */
bool compare_worlds(const struct world *a, const struct world *b, struct difference *difference);

#endif
