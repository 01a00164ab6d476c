/* Broad phase: which bodies can meet in this frame. Moving bodies are put into the gridsquares that
 * the boxes around their sweeps touch, by a radix sort of (square, row) keys, so that the cost
 * follows the bodies and not the 160,000 squares; fixed ones are found by the squares' reach. */
#ifndef JOLON_COLLIDER_BROAD_H
#define JOLON_COLLIDER_BROAD_H

#include "collider/sweep.h"
#include "world/workers.h"
#include "world/world.h"

#include <stdint.h>

/* Bodies that press on each other slower than this lean [m/s]: what an engine adds within a step,
 * and at least half a metre a second. A body that leans leaves its way by at most as much. */
static inline double lean_mps(double dt_s)
{
    return maths_max(0.5, 10.0 * dt_s);
}

/* What a pair's second side is. */
#define PAIR_FIXED 0x80000000u /* flag: the rest is a fixed object's index */

struct pair {
    uint32_t a; /* a row, the lower of two */
    uint32_t b; /* a row, or a fixed object with PAIR_FIXED */
};

struct pair_list {
    struct pair *pair;
    uint32_t count, capacity;
};

/* Box around the sweep of a row's sphere. */
struct sweep_box {
    float min_x, min_y, min_z, max_x, max_y, max_z; /* rounded outwards */
};

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

/* What the broad phase looks at. */
struct broad_input {
    const struct entities *entities; /* at the end of the frame */
    const struct path *path;         /* [rows] */
    const uint8_t *fixed_damage;
    const struct crater_index *craters;
    uint32_t rows;
};

/* Fills the lists with every pair whose swept boxes overlap, each once. Pairs that can never
 * collide are left out: a munition and its shooter, two wrecks at rest, a fixed object that is
 * already down. 0, or -1 with errno ENOMEM. */
int broad_pairs(struct broad *broad, const struct broad_input *input);

/* Rows whose boxes touch the square, after broad_pairs: entries first .. first + count - 1. */
uint32_t broad_square(const struct broad *broad, uint32_t square, const struct bin_entry **first);

#endif
