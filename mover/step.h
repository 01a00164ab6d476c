/* The mover's step: from committed world k to the moved table k + 1. Pure: no IPC, no clock, no
 * I/O; the same bytes on any number of threads. */
#ifndef JOLON_MOVER_STEP_H
#define JOLON_MOVER_STEP_H

#include "mover/agent/avoidance.h"
#include "mover/agent/neighbour_lists.h"
#include "mover/query/neighbour_index.h"
#include "mover/query/line_of_sight.h"
#include "mover/query/slope_max_map.h"
#include "mover/query/ground_marks.h"
#include "world/checksum.h"
#include "world/runtime/thread_pool.h"
#include "world/world.h"

/* One command ring as the step sees it: commands sequence .. end - 1 may be taken. */
struct command_source {
    const struct command *slot;
    uint64_t slots; /* power of two */
    uint64_t end;
};

/* Columns of the moved table's pieces that changed since they were hashed. */
struct moved_pieces {
    uint64_t changed[CHECKSUM_PIECES];
};

struct mover {
    const struct world *world;
    struct crater_index craters;    /* cache of the committed craters */
    struct neighbour_index near;    /* of the committed vehicles; of this frame */
    struct line_of_sight outlook;   /* over the committed ground; of this frame */
    struct neighbour_lists company; /* likewise */
    struct avoidance avoid;         /* of the kinds */
    struct ground_marks scars;      /* cache of the committed craters and damage */
    struct slope_max_map easy;      /* cache of the ground's slopes and water */
    struct terrain_cache_entry
        *patches; /* [capacity + GROUND_POSE_AHEAD] cache of the ground about each row */
    struct terrain_cache_entry *patches_ahead; /* [capacity] where aircraft soon will be */
    struct thread_pool *workers;               /* NULL: alone */
    struct moved_pieces pieces;                /* of this frame */
    struct piece_hashes blank;                 /* of a piece that is all zero */
    uint64_t left; /* checksum of the moved table that it left; 0: none */
};

/* craters: the world's list. 0, or -1 with errno ENOMEM. workers may be NULL and stays the
 * caller's. */
int mover_init(struct mover *mover, const struct world *world, const struct crater *craters,
               struct thread_pool *workers);
void mover_free(struct mover *mover);

/* Fills moved from the committed state and the commands. It takes no memory and asks the kernel for
 * nothing but to wake the workers. */
void mover_step(struct mover *mover, const struct state *committed, struct moved *moved,
                const struct command_source sources[COMMAND_RING_COUNT]);

#endif
