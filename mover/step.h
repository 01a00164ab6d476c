/* The mover's step: from committed world k to the moved table k + 1. Pure: no IPC, no clock, no
 * I/O; the same bytes on any number of threads. */
#ifndef JOLON_MOVER_STEP_H
#define JOLON_MOVER_STEP_H

#include "mover/avoid.h"
#include "mover/company.h"
#include "mover/near.h"
#include "mover/outlook.h"
#include "mover/easy.h"
#include "mover/scars.h"
#include "world/checksum.h"
#include "world/workers.h"
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
    struct crater_index craters;   /* cache of the committed craters */
    struct near near;              /* of the committed vehicles; of this frame */
    struct outlook outlook;        /* over the committed ground; of this frame */
    struct company company;        /* likewise */
    struct avoid avoid;            /* of the kinds */
    struct scars scars;            /* cache of the committed craters and damage */
    struct easy easy;              /* cache of the ground's slopes and water */
    struct footing_patch *patches; /* [capacity + STAND_AHEAD] cache of the ground about each row */
    struct footing_patch *patches_ahead; /* [capacity] where aircraft soon will be */
    struct workers *workers;             /* NULL: alone */
    struct moved_pieces pieces;          /* of this frame */
    struct piece_hashes blank;           /* of a piece that is all zero */
    uint64_t left;                       /* checksum of the moved table that it left; 0: none */
};

/* craters: the world's list. 0, or -1 with errno ENOMEM. workers may be NULL and stays the
 * caller's. */
int mover_init(struct mover *mover, const struct world *world, const struct crater *craters,
               struct workers *workers);
void mover_free(struct mover *mover);

/* Fills moved from the committed state and the commands. It takes no memory and asks the kernel for
 * nothing but to wake the workers. */
void mover_step(struct mover *mover, const struct state *committed, struct moved *moved,
                const struct command_source sources[COMMAND_RING_COUNT]);

#endif
