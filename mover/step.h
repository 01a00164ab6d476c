/* The mover's step: from committed world k to the moved table k + 1. Pure: no IPC, no clock, no
 * I/O; the same bytes on any number of threads. */
#ifndef JOLON_MOVER_STEP_H
#define JOLON_MOVER_STEP_H

#include "mover/agent/avoidance.h"
#include "mover/agent/neighbour_lists.h"
#include "mover/command_apply.h"
#include "mover/query/ground_marks.h"
#include "world/checksum.h"
#include "world/entity/command.h"
#include "world/runtime/thread_pool.h"
#include "world/terrain/crater.h"
#include "world/terrain/square_bounds.h"

struct moved;
struct state;
struct terrain_cache_entry;
struct world;

struct mover {
    const struct world *world;
    struct crater_index craters;            /* cache of the committed craters */
    struct neighbour_index neighbours;      /* of the committed vehicles; of this frame */
    struct line_of_sight line_of_sight;     /* over the committed ground; of this frame */
    struct neighbour_lists neighbour_lists; /* likewise */
    struct avoidance avoidance;             /* of the kinds */
    struct ground_marks ground_marks;       /* cache of the committed craters and damage */
    struct square_bounds slopes;            /* of the ground; squares with water have none */
    struct terrain_cache_entry
        *terrain_entries; /* [capacity + GROUND_POSE_AHEAD] cache of the ground about each row */
    struct terrain_cache_entry *terrain_entries_ahead; /* [capacity] where aircraft soon will be */
    struct thread_pool *workers;                       /* NULL: alone */
    uint64_t changed[CHECKSUM_PIECES];                 /* of this frame */
    struct piece_hashes blank;                         /* of a piece that is all zero */
    uint64_t left; /* checksum of the moved table that it left; 0: none */
};

/* craters: the world's list. 0, or -1 with errno ENOMEM. workers may be NULL and stays the
 * caller's. */
int mover_init(struct mover *mover, const struct world *world, const struct crater *craters,
               struct thread_pool *workers);
void mover_free(struct mover *mover);

/* The context of the frame after committed. */
struct step_context mover_context(const struct mover *mover, const struct state *committed,
                                  struct moved *moved);

/* Fills moved from the committed state and the commands. It takes no memory and asks the kernel for
 * nothing but to wake the workers. */
void mover_step(struct mover *mover, const struct state *committed, struct moved *moved,
                const struct command_source sources[COMMAND_RING_COUNT]);

#endif
