/* The pairs of a frame: which there are, and the search for those of a row. Pure; one
 * caller, and its workers. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_CONTACT_PAIRS_H
#define JOLON_COLLIDER_NARROW_PHASE_CONTACT_PAIRS_H

#include "collider/narrow_phase/contact_queue.h"

#include <stdbool.h>

/* Begins a frame with these lists of pairs, of which nothing is known yet. No row has any. */
void contact_pairs_begin(struct contact_queue *contacts, const struct pair_list *lists,
                         uint32_t list_count);

/* Adds a pair that is not there yet, and returns its index. */
uint32_t contact_pairs_add(struct contact_queue *contacts, struct pair pair);

/* Returns the index + 1 of a pair, or 0. */
uint32_t contact_pairs_find(const struct contact_queue *contacts, const struct pair *pair);

/* Pairs the row with the bodies near its new path: those that the broad phase finds, and the rows
 * that have left their boxes. resting: also with bodies that rest. wider_m: to all four sides. */
void contact_pairs_look(struct contact_queue *contacts, const struct contact_input *input,
                        uint32_t row, bool resting, float wider_m);

#endif
