/* Broad phase: which bodies can meet in this frame. The world is cut into strips, rows of 400
 * gridsquares. First each moving body goes, as a record of 16 bytes, into every strip that the box
 * around its sweep touches (nearly always one); then each strip is sorted from west to east and
 * swept, against itself and against the fixed objects that stand in it. Both passes run in
 * parallel, by rows and by strips, and the cost follows the bodies: 500 of them cost little more
 * than 500 records. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_BROAD_PHASE_H
#define JOLON_COLLIDER_BROAD_PHASE_BROAD_PHASE_H

#include "collider/motion/pair_filter.h"
#include "collider/motion/body_motion.h"
#include "collider/broad_phase/static_boxes.h"
#include "collider/broad_phase/sweep_and_prune.h"
#include "world/runtime/thread_pool.h"

#include <stdint.h>

struct world;

struct broad_phase {
    const struct world *world;
    struct thread_pool *workers;
    struct path_box *box; /* [capacity] of every row that is there */
    struct static_boxes fixed_boxes;
    struct sweep_worker *sweeper; /* [sweepers] one a worker */
    uint32_t sweepers;
    struct pair_list list[THREAD_POOL_MAX]; /* one a worker: their order does not matter, since
                                           contacts are put in a total order */
};

/* 0, or -1 with errno ENOMEM. The world's fixed objects are taken as they stand now. workers stays
 * the caller's. */
int broad_phase_init(struct broad_phase *broad, const struct world *world,
                     struct thread_pool *workers);
void broad_phase_free(struct broad_phase *broad);

/* Fills the lists with every pair whose swept boxes overlap, each once; of bodies that cross
 * several strips on a long way, only those that are near each other in one of them. Pairs that can
 * never collide are left out: a munition and its shooter, two wrecks at rest, a fixed object that
 * is already down. The set of pairs does not depend on the threads; their order may. */
void broad_phase_pairs(struct broad_phase *broad, const struct method_input *input);

/* Fills rows first .. end - 1 of what detection looks at; first is a multiple of
 * BROAD_PHASE_ROWS_TAKEN. */
typedef void broad_phase_take(void *context, uint32_t first, uint32_t end);

#define BROAD_PHASE_ROWS_TAKEN 1024 /* at a time: they fit a processor's own cache */

/* The same, of ways that are motion's and not drawn yet: drawn are then those of fliers and of who
 * is in several strips. Whoever else is in a pair, or found by a query, is the caller's to draw.
 * take is called once for all rows before they are looked at, a few at a time and on any thread;
 * NULL: they are there. */
void broad_phase_pairs_moved(struct broad_phase *broad, const struct method_input *input,
                             struct body_motion *motion, broad_phase_take *take, void *context);

/* How long a list must be that both queries are added to, one after the other, behind one pair. */
uint64_t broad_phase_found_most(const struct world *world);

/* After broad_phase_pairs: adds every row whose box (broad->box) meets this one, as pair.a, each
 * once, ascending; pair.b is 0. A row on a long way counts where it passes. found has room for
 * broad_phase_found_most() pairs. */
void broad_phase_query(const struct broad_phase *broad, const struct method_input *input,
                       const struct path_box *box, struct pair_list *found);

/* Adds every fixed object, standing or down, whose box meets this one, as pair.b with PAIR_FIXED,
 * each once, ascending; pair.a is 0. */
void broad_phase_query_fixed(const struct broad_phase *broad, const struct method_input *input,
                             const struct path_box *box, struct pair_list *found);

#endif
