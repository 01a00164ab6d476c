/* What a method of detection needs beside a small world, and the pairs that it finds there. For
 * tests of the methods' rules. */
#ifndef JOLON_TESTS_SUPPORT_PAIR_SEARCH_H
#define JOLON_TESTS_SUPPORT_PAIR_SEARCH_H

#include "collider/method/method.h"
#include "tests/support/small_world.h"

#include <stdbool.h>
#include <stdint.h>

struct pair_search {
    struct small_world *w;
    struct method_workspace *workspace; /* without a broad phase */
    struct pair_list pairs;             /* that the last run found */
};
extern struct pair_search pair_search;

/* Begins searches of this world, with room for so many pairs. Returns 0, or -1 without memory. */
int pair_search_open(struct small_world *w, uint64_t most);

/* Tear-down for cmocka: ends the searches and the world. */
int pair_search_teardown(void **state);

/* Returns how many pairs the method finds. */
uint32_t pair_search_run(method_pairs_function *method);

/* Returns true if it found (a, b), in this order. */
bool pair_search_has(uint32_t a, uint32_t b);

#endif
