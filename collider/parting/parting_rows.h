/* The rows that part in a frame, and their pairs, each listed once. Pure; one caller. */
#ifndef JOLON_COLLIDER_PARTING_PARTING_ROWS_H
#define JOLON_COLLIDER_PARTING_PARTING_ROWS_H

#include "collider/motion/pair_filter.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The collider's own memory. */
struct parting_rows {
    uint32_t *row; /* [count] in the order in which they were added */
    uint32_t count;
    uint32_t *place;        /* [capacity of the world] index + 1 into row, else 0 */
    struct pair_list list;  /* of rows */
    uint64_t pair_capacity; /* of the array that goes with the list */
};

/* Returns 0, or -1 with errno ENOMEM. */
int parting_rows_init(struct parting_rows *rows, const struct world *world);
void parting_rows_free(struct parting_rows *rows);

/* Adds a row at the end of the list. Returns false if it is there already. */
bool parting_rows_add(struct parting_rows *rows, uint32_t row);

/* Empties both lists. */
void parting_rows_forget(struct parting_rows *rows);

/* Puts the pairs into an order that does not depend on how they were found. Returns the array that
 * has a place of this size for each pair: the given one, or a larger one without its content. */
void *parting_rows_sort(struct parting_rows *rows, void *of_pairs, size_t size);

#endif
