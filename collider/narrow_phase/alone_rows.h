/* Finds the bodies near which nothing is, on all workers. In the first frame every body is new and
 * has to be looked at, and nearly all of them are alone. The collider's own memory. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_ALONE_ROWS_H
#define JOLON_COLLIDER_NARROW_PHASE_ALONE_ROWS_H

#include "collider/motion/pair_filter.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

struct contact_input;
struct thread_pool;
struct world;

struct alone_rows {
    struct thread_pool *workers; /* the caller's; NULL: one thread */
    struct pair_list *near;      /* [threads] what a worker's query has found */
    bool *alone;                 /* [capacity of the world] of the rows that were asked for */
    _Atomic uint8_t *company;    /* [capacity of the world] 1: something may be near the row */
};

/* Returns 0, or -1 with errno ENOMEM. */
int alone_rows_init(struct alone_rows *rows, const struct world *world,
                    struct thread_pool *workers);
void alone_rows_free(struct alone_rows *rows);

/* Sets alone of these rows, each of which is listed once: true if the row's box is within the one
 * that the broad phase has, and meets neither the box of another row nor that of a fixed object. It
 * follows from the tables, not from the boxes of stretches that are kept. A row that strays from
 * its box later may come near one of them. */
void alone_rows_find(struct alone_rows *rows, const struct contact_input *input,
                     const uint32_t *row, uint32_t count);

#endif
