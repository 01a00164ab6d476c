/* The mover's step: from the committed world k to the moved table k + 1. Pure: no IPC, no clock, no
 * I/O. The result is the same to the bit on any number of threads. */
#ifndef JOLON_MOVER_STEP_H
#define JOLON_MOVER_STEP_H

#include "mover/agent/avoidance.h"
#include "mover/agent/neighbour_lists.h"
#include "mover/command_apply.h"
#include "mover/query/ground_marks.h"
#include "mover/query/remote_index.h"
#include "mover/resting_rows.h"
#include "world/checksum.h"
#include "world/entity/command.h"
#include "world/runtime/thread_pool.h"
#include "world/terrain/crater.h"
#include "world/terrain/square_bounds.h"

struct firing_table;
struct moved;
struct state;
struct terrain_cache_entry;
struct world;

struct mover {
    const struct world *world;
    struct thread_pool *workers; /* NULL: none */
    /* What follows from the static world. */
    struct avoidance avoidance;
    struct square_bounds slopes;
    struct firing_table *firing_tables; /* [kinds of files] */
    /* Of the committed world, changed in each frame. */
    struct neighbour_index neighbours;
    struct neighbour_lists neighbour_lists;
    struct line_of_sight line_of_sight;
    /* Caches of the committed world. */
    struct crater_index craters;
    struct ground_marks ground_marks;
    struct terrain_cache_entry *terrain_entries;       /* [capacity + GROUND_POSE_AHEAD] */
    struct terrain_cache_entry *terrain_entries_ahead; /* [capacity] */
    struct resting_rows resting;
    /* Of the moved table, while records of other simulators are applied. */
    struct remote_index remotes;
    /* The moved table. */
    uint64_t *asks;   /* a bit for each row that has a trigger (mover/triggers.h) */
    uint64_t *serial; /* a bit for each row that the serial part of the step has written */
    uint64_t
        *change;   /* [capacity] by how much a row that was moved changes the hash of its block */
    uint64_t left; /* checksum that the last step left; 0: none */
    _Atomic uint32_t moved_rows; /* rows that the last step has moved */
    uint32_t
        decides_every; /* [frame] tests let agents decide no more often, as in a large world; 0 */
};

/* craters: the world's list. workers may be NULL and stays the caller's. 0, or -1 with errno
 * ENOMEM.
 */
int mover_init(struct mover *mover, const struct world *world, const struct crater *craters,
               struct thread_pool *workers);
void mover_free(struct mover *mover);

/* Takes the memory of the steps of this many rows, so that no step waits for its pages, and the
 * pages of the tables: of the moved table for writing, of the world's two buffers for reading. For
 * a stand-by process too. */
void mover_touch(const struct mover *mover, const struct moved *moved, const struct state states[2],
                 uint32_t rows);

/* The context of the frame after committed. */
struct step_context mover_context(const struct mover *mover, const struct state *committed,
                                  struct moved *moved);

/* Fills moved from the committed state and the commands. Makes no system call except to wake the
 * workers. */
void mover_step(struct mover *mover, const struct state *committed, struct moved *moved,
                const struct command_source sources[COMMAND_RING_COUNT]);

#endif
