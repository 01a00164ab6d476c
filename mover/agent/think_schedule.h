/* Turns: whose turn it is among the rows of a piece of the table. They think, and try to fire,
 * before the piece is moved, so that the loop that moves it only asks what their controls ask. What
 * a row thinks follows from the committed world and its own row: it does not matter when it does.
 */
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
    MOTION_COURSE, /* an agent that has not thought: by its controls */
    MOTION_AGENT,  /* one that has: likewise */
    MOTION_ALONE,  /* on a script or driven: has the controls to itself and thinks as it moves */
};

/* A piece before it moves. */
struct row_block {
    uint32_t first, end; /* rows; at most CHECKSUM_ROWS */
    uint64_t changed;    /* columns that commands of this frame changed */
    uint64_t blank;      /* others that are zero in every row; those need not be read */
};

/* Columns that say whether anybody spins, and whether any gun moves, is to or has a target. */
#define SPIN_COLUMNS (COLUMN_BIT(spin_x) | COLUMN_BIT(spin_y) | COLUMN_BIT(spin_z))
#define GUN_COLUMNS                                                                                \
    (COLUMN_BIT(turret) | COLUMN_BIT(gun) | COLUMN_BIT(traverse) | COLUMN_BIT(elevate) |           \
     COLUMN_BIT(target_id))

static inline bool row_block_lacks(const struct row_block *block, uint64_t columns)
{
    return (block->blank & columns) == columns;
}

/* Sets motion[0 ..] of the piece's rows; turns those that spin, and lets those think whose turn it
 * is or to whom something happened. */
void think_schedule_run(const struct step_context *context, const struct row_block *block,
                        uint8_t motion[CHECKSUM_ROWS]);

#endif
