/* When a vehicle begins to cruise (world/entity/cruise.h).
 *
 * Rows that stand together in the table begin their stretches in the same frame, so that a frame
 * writes to few blocks. Such groups take turns. In a large world a group is a block; a small one
 * has smaller groups, so that each frame has its share of the work. A vehicle may begin a stretch
 * when its group's turn comes, if it is on its way, nothing has happened to it and its gun is at
 * rest. One that could not, or that something has stopped, tries again some frames later, and one
 * whose stretch was made shorter when that ends: for a stretch to the next turn of its group. A
 * land vehicle or a ship that avoids something or has to slow down, also for the ground ahead,
 * begins its stretches when its agent decides, and they last until the next decision. Its agent
 * then decides at once whatever falls due within the stretch. The motion of the stretch is that of
 * one long frame (mover/motion/ground_vehicle.h), which refuses what is not easy.
 *
 * Reads row i of the moved table. Any thread, each its own row. */
#ifndef JOLON_MOVER_CONTEXT_CRUISE_START_H
#define JOLON_MOVER_CONTEXT_CRUISE_START_H

#include "mover/context/step_context.h"

#define CRUISE_START_LEAST 5u /* [frame] of a stretch: a shorter one does not pay */

/* Returns how many rows a group has in a world of this capacity, from 16 to CHECKSUM_ROWS: the
 * logarithm to base 2. */
uint32_t cruise_start_group_bits(uint32_t capacity);

/* Returns the frames of the longest stretch of a land vehicle, or of an aircraft in a crowd, in a
 * world with frames of dt_s, whose agents decide every think_frames: as long as DECISIONS of them,
 * from CRUISE_S to CRUISE_LONG_S. */
uint32_t cruise_start_longest(double dt_s, uint32_t think_frames);

/* Returns true in a crowd, whose agents decide less often than stretches begin: a stretch delays no
 * decision. */
bool cruise_start_crowd(const struct step_context *context);

/* Returns how many frames a stretch has that row i may begin in this frame; 0: it may not. */
uint32_t cruise_start_frames(const struct step_context *context, uint32_t i);

/* Returns true if something that row i's agent does every `period` frames falls due within the
 * stretch that it may begin in this frame. */
bool cruise_start_due(const struct step_context *context, uint32_t i, uint32_t period);

/* Returns how many frames there are at least from a decision of row i's agent in this frame to the
 * next. */
uint32_t cruise_start_think_frames(const struct step_context *context, uint32_t i);

#endif
