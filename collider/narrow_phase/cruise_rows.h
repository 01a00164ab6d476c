/* The rows that cruise (world/entity/cruise.h) and may meet something in this frame. A row whose
 * stretch something is in the way of ends it: its fields then say where it is at the end of this
 * frame, and it is a row like any other. Nothing else of the collider looks at rows that cruise.
 *
 * Which rows end their stretch follows from the tables alone, not from what the broad phase has
 * kept: it finds more pairs than those whose boxes meet. One thread.
 *
 * They write to input->writer, and change input->motion. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_CRUISE_ROWS_H
#define JOLON_COLLIDER_NARROW_PHASE_CRUISE_ROWS_H

#include "collider/motion/pair_filter.h"

struct contact_input;

/* Ends the stretch of the row if it cruises in this frame. */
void cruise_rows_stop(const struct contact_input *input, uint32_t row);

/* Takes the pairs out of the list in which a row cruises and that do not come near to each other.
 * Of the others the stretch of one row ends before they do, that which loses less by it, or both
 * do; if that is soon, both end at once, and the pair stays in the list. ends: its content is lost.
 */
void cruise_rows_take_pairs(const struct contact_input *input, struct pair_list *pairs,
                            struct pair_list *ends);

/* Returns false if the row cruises and its box of this frame does not meet this one, although the
 * box that the broad phase has kept may. Any thread. */
bool cruise_rows_box_meets(const struct contact_input *input, uint32_t row,
                           const struct path_box *box);

/* broad_phase_query(), which also ends the stretches of the rows that it finds. Rows that cruise
 * and whose boxes do not meet this one are not found. */
void cruise_rows_query(const struct contact_input *input, const struct path_box *box,
                       struct pair_list *found);

/* When all responses of the frame are done: ends the stretches that the rows which responses have
 * written now are in the way of. So at the end of a frame no body is both in the box around what is
 * left of another one's stretch and near to its line, and in the next frame only bodies that move
 * can come there. found: for rows, is emptied. */
void cruise_rows_meet_written(const struct contact_input *input, struct pair_list *found);

#endif
