/* Moves the rows of a block (mover/agent/think_schedule.h) by one frame, or by the stretch that
 * they begin: agents decide and aim, then each row moves as its behaviour and its kind say.
 *
 * Writes only rows of this block of the moved table. Any thread, each its own block. */
#ifndef JOLON_MOVER_ROW_BLOCK_MOVE_H
#define JOLON_MOVER_ROW_BLOCK_MOVE_H

#include "mover/agent/think_schedule.h"
#include "mover/context/step_context.h"

#include <stdint.h>

/* Moves the rows of the block that are awake. motion: how each row has moved (enum motion), written
 * for all rows of the block. */
void row_block_move(const struct step_context *context, const struct row_block *block,
                    uint8_t motion[CHECKSUM_ROWS]);

#endif
