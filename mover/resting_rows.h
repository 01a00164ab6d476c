/* The rows that rest: moving them would write nothing different, so they are not moved
 * (docs/decisions/042-resting-rows.md).
 *
 * This is a cache of one process. It is empty after a start, and no bit of a result depends on it.
 * A row begins to rest in a frame in which it was moved and nothing in it changed, if it can only
 * change by an event: a wreck at rest, a vehicle that holds its course and stands, and an agent
 * that stands by its order and has nothing to decide. An agent that has something to look for rests
 * between its turns to decide. An aircraft that hovers is moved in the frames in which it burns
 * fuel. An entity of another simulator rests if its owner says that it stands.
 *
 * A row wakes when anything writes to it: a command, a shot, a response of the collider, or when a
 * crater is dug near it. One that hovers also wakes when an aircraft moves near it. */
#ifndef JOLON_MOVER_RESTING_ROWS_H
#define JOLON_MOVER_RESTING_ROWS_H

#include "mover/agent/think_schedule.h"
#include "mover/context/step_context.h"
#include "mover/hover_watch.h"
#include "world/checksum.h"

struct neighbour_lists;

struct resting_rows {
    uint64_t *resting;  /* [capacity / 64] a bit for each row that rests */
    uint64_t *turns;    /* [capacity / 64] of these, the rows that are moved when they decide */
    uint64_t *cruising; /* and those that are moved when their stretch ends */
    uint64_t *fresh;    /* those whose stretch has begun in the last step: their entry in the index
                           of neighbours is not yet right */
    uint32_t *end;      /* [capacity] when the stretch of a row that cruises ends */
    uint32_t *ends;     /* [capacity / 64] no stretch of these rows ends before this tick */
    struct hover_watch hovering;
    uint32_t craters; /* that have woken the rows near them */
    bool never;       /* for tests: no row rests */
};

/* No row rests. 0, or -1 with errno ENOMEM. */
int resting_rows_init(struct resting_rows *rows, uint32_t capacity, double side_m);
void resting_rows_free(struct resting_rows *rows);

/* Wakes all rows of a block. */
void resting_rows_wake_block(struct resting_rows *rows, uint32_t block);

/* Wakes the rows of a block that these bits name, [ROW_BLOCK_WORDS]. */
void resting_rows_wake(struct resting_rows *rows, uint32_t block, const uint64_t *bits);

/* Wakes the rows near the craters that are new in the committed world. The index of neighbours is
 * that of this frame. */
void resting_rows_wake_craters(struct resting_rows *rows, const struct step_context *context);

/* Wakes the rows that hover near an aircraft that moves. The index of neighbours is that of this
 * frame. */
void resting_rows_wake_hovering(struct resting_rows *rows, const struct step_context *context);

/* Sets which rows of a block are moved in this frame, and returns how many they are. */
uint32_t resting_rows_awake(const struct resting_rows *rows, const struct step_context *context,
                            struct row_block *block);

/* Finds out which of the rows that were moved rest from now on. motion: enum motion of each row of
 * the block. */
void resting_rows_settle(struct resting_rows *rows, const struct step_context *context,
                         const struct row_block *block, const uint8_t *motion,
                         struct neighbour_index *neighbours, struct neighbour_lists *lists);

#endif
