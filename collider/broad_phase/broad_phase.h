/* Broad phase: finds the bodies that may meet in this frame. The world is cut into strips, rows of
 * 400 gridsquares. First a record of 16 bytes for each moving body goes into every strip that the
 * box around its path touches (nearly always one). Then each strip is sorted from west to east and
 * swept against itself and against its fixed objects. Both passes run in parallel, by rows and by
 * strips. The cost grows with the number of bodies, not with the size of the world. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_BROAD_PHASE_H
#define JOLON_COLLIDER_BROAD_PHASE_BROAD_PHASE_H

#include "collider/motion/pair_filter.h"
#include "collider/motion/body_motion.h"
#include "collider/broad_phase/static_boxes.h"
#include "collider/broad_phase/query_index.h"
#include "collider/broad_phase/cruise_index.h"
#include "collider/broad_phase/resting_records.h"
#include "collider/broad_phase/sweep_and_prune.h"
#include "world/runtime/thread_pool.h"

#include <stdint.h>

struct persistent_contact;
struct world;

struct broad_phase {
    const struct world *world;
    struct thread_pool *workers;
    struct path_box *box; /* [capacity] of every used row */
    uint8_t *wider;       /* [capacity] enum body_box_wider */
    uint32_t *widened;    /* rows that are not BODY_BOX_EXACT */
    uint32_t widened_count;
    struct static_boxes fixed_boxes;
    struct sweep_worker *sweeper; /* [sweepers] one for each worker */
    uint32_t sweepers;
    struct resting_records resting;         /* whose rows are in no bin */
    struct cruise_index cruise;             /* rows that cruise, which are in no bin either */
    uint64_t *binned;                       /* a bit for each row that is in a bin */
    bool cruises;                           /* the world has rows that cruise */
    struct query_index index;               /* of this frame, once many queries are expected */
    struct pair_list list[THREAD_POOL_MAX]; /* one for each worker; their order does not matter,
                                               since contacts are put in a total order */
};

/* Returns 0, or -1 with errno ENOMEM. The fixed objects' positions are read here. workers stays the
 * caller's. */
int broad_phase_init(struct broad_phase *broad, const struct world *world,
                     struct thread_pool *workers);
void broad_phase_free(struct broad_phase *broad);

/* Takes the memory for this many rows, spread over the map, before a step needs it. */
void broad_phase_touch(const struct broad_phase *broad, uint32_t rows);

/* Fills the lists with every pair whose swept boxes overlap, each pair once. Bodies with long paths
 * through several strips are paired only if they are near each other in one of the strips. Pairs
 * that can never collide are left out: a munition and its shooter, two wrecks at rest, a destroyed
 * fixed object. The set of pairs does not depend on the number of threads; their order may. */
void broad_phase_pairs(struct broad_phase *broad, const struct method_input *input);

/* Rows taken at a time: so many fit into a core's cache. */
#define BROAD_PHASE_ROWS_TAKEN RESTING_RECORDS_ROWS

/* Fills rows first .. end - 1 of the entities that detection reads; first is a multiple of
 * BROAD_PHASE_ROWS_TAKEN. Sets which of them move. */
typedef void broad_phase_take(void *context, uint32_t first, uint32_t end,
                              struct moving_rows *moving);

/* The same with paths that motion computes on demand. Only the paths of fliers and of rows in
 * several strips are computed here; the caller computes the path of every other row in a pair or a
 * query result. take is called once for each block of rows, on any thread, before the rows are
 * read; NULL: the rows are complete. */
void broad_phase_pairs_moved(struct broad_phase *broad, const struct method_input *input,
                             struct body_motion *motion, broad_phase_take *take, void *context);

/* After broad_phase_pairs_moved, when the stretches have ended that something is in the way of:
 * keeps the boxes of the rows that cruise. */
void broad_phase_hold(struct broad_phase *broad, const struct body_motion *motion);

/* Lets the rows go that no longer cruise: they move, or have been written. The moving rows of a
 * frame of this many rows have been noted. */
void broad_phase_let_go(struct broad_phase *broad, uint32_t rows);

/* Forgets all that is kept from frame to frame: rows may have moved without having been noted. */
void broad_phase_forget(struct broad_phase *broad);

/* Before broad_phase_pairs_moved: the boxes of the rows in these contacts are to be wider in this
 * frame, because collisions will change their paths. contact: NULL for none. */
void broad_phase_widen(struct broad_phase *broad, const struct persistent_contact *contact,
                       uint32_t count);

/* Returns true if the lists have all pairs of the row with bodies that meet its box, on which its
 * path has not been looked at yet. */
bool broad_phase_has_all(const struct broad_phase *broad, uint32_t row);

/* Returns how many pairs a list must have room for if both queries add to it for one row. */
uint64_t broad_phase_found_most(const struct world *world);

/* After broad_phase_pairs: prepares for so many queries in this frame, if they are many. They find
 * the same rows without it, but read every record of a strip. One thread. */
void broad_phase_expect_queries(struct broad_phase *broad, uint32_t queries);

/* Returns true if many queries are expected, and each row of this frame that is in use has a record
 * in a bin: record_overlaps_find() then tells of all of them. */
bool broad_phase_has_records(const struct broad_phase *broad, uint32_t rows);

/* After broad_phase_pairs: adds every row whose box (broad->box) meets this box as pair.a, each
 * once, ascending; pair.b is 0. A row with a long path is found only near the path. found must have
 * room for broad_phase_found_most() pairs. */
void broad_phase_query(const struct broad_phase *broad, const struct method_input *input,
                       const struct path_box *box, struct pair_list *found);

/* Adds every fixed object, standing or destroyed, whose box meets this box, as pair.b with
 * PAIR_FIXED, each once, ascending; pair.a is 0. */
void broad_phase_query_fixed(const struct broad_phase *broad, const struct method_input *input,
                             const struct path_box *box, struct pair_list *found);

#endif
