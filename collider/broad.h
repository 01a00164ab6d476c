/* Broad phase: which bodies can meet in this frame. Moving bodies are put into the gridsquares that
 * the boxes around their sweeps touch, by a radix sort of (square, row) keys, so that the cost
 * follows the bodies and not the 160,000 squares; fixed ones are found by the squares' reach. */
#ifndef JOLON_COLLIDER_BROAD_H
#define JOLON_COLLIDER_BROAD_H

#include "collider/detect.h"
#include "world/workers.h"
#include "world/world.h"

#include <stdint.h>

struct bin_entry {
    uint32_t square;
    uint32_t row;
};

struct broad {
    const struct world *world;
    struct workers *workers;
    struct sweep_box *box; /* [capacity] */
    struct bin_entry *entry, *other;
    uint32_t entry_count, entry_capacity;
    struct pair_list list[WORKERS_MAX]; /* one a worker: their order does not matter, since contacts
                                           are put in a total order */
};

/* 0, or -1 with errno ENOMEM. workers stays the caller's. */
int broad_init(struct broad *broad, const struct world *world, struct workers *workers);
void broad_free(struct broad *broad);

/* Fills the lists with every pair whose swept boxes overlap, each once. Pairs that can never
 * collide are left out: a munition and its shooter, two wrecks at rest, a fixed object that is
 * already down. 0, or -1 with errno ENOMEM. */
int broad_pairs(struct broad *broad, const struct detect_input *input);

/* Rows whose boxes touch the square, after broad_pairs: entries first .. first + count - 1. */
uint32_t broad_square(const struct broad *broad, uint32_t square, const struct bin_entry **first);

#endif
