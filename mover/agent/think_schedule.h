/* Which rows of a block decide in this frame. They decide, and try to fire, before the block moves,
 * so that the loop that moves it only reads their controls. A decision follows from the committed
 * world and the agent's own row, so the order of decisions does not matter. */
#ifndef JOLON_MOVER_AGENT_THINK_SCHEDULE_H
#define JOLON_MOVER_AGENT_THINK_SCHEDULE_H

#include "mover/context/step_context.h"
#include "world/checksum.h"

/* How a row moves in this frame. */
enum motion {
    MOTION_NONE, /* free, or new in this frame */
    MOTION_WRECK,
    MOTION_FLIGHT,
    MOTION_HOLD,
    MOTION_COURSE, /* an agent that has not decided: by its controls */
    MOTION_AGENT,  /* an agent that has decided: also by its controls */
    MOTION_ALONE,  /* on a script or driven: it decides as it moves */
    MOTION_REMOTE, /* by dead reckoning: another simulator owns it */
    MOTION_CRUISE, /* on a stretch: nothing writes to its row */
};

/* A block of rows before it moves. */
struct row_block {
    uint32_t first, end;             /* rows; at most CHECKSUM_ROWS */
    uint64_t awake[ROW_BLOCK_WORDS]; /* a bit for each row that is moved in this frame */
    bool all;                        /* all are */
};

/* Returns the first row from `row` on that is moved in this frame, or end. */
static inline uint32_t row_block_next(const struct row_block *block, uint32_t row)
{
    if (block->all || row >= block->end)
        return row;
    uint32_t n = (row - block->first) / 64;
    uint64_t word = block->awake[n] & UINT64_MAX << (row - block->first) % 64;
    while (word == 0 && ++n < ROW_BLOCK_WORDS)
        word = block->awake[n];
    return word == 0 ? block->end : block->first + n * 64 + (uint32_t)__builtin_ctzll(word);
}

/* Sets motion[] of the block's rows (MOTION_NONE: it is not moved), turns the rows that spin, and
 * lets the agents decide that are due or that must react to an event. */
void think_schedule_run(const struct step_context *context, const struct row_block *block,
                        uint8_t motion[CHECKSUM_ROWS]);

#endif
