/* The contacts of a frame in the order of their times. Pure; one thread. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_CONTACT_HEAP_H
#define JOLON_COLLIDER_NARROW_PHASE_CONTACT_HEAP_H

#include "collider/narrow_phase/contact_queue.h"

#include <stdbool.h>

/* The two ends of a row's path: ground, and end of life. */
#define CONTACT_HEAP_ENDS 2u

/* Returns the greatest number of valid contacts: each pair has at most one, and each row two
 * ends. */
uint32_t contact_heap_most(const struct contact_queue *contacts, uint32_t pairs);

/* Returns true if the contact was computed from the present paths of its bodies. */
bool contact_heap_is_valid(const struct contact_queue *contacts, const struct contact *contact);

/* Makes a heap of contacts in any order. */
void contact_heap_order(struct contact_list *heap);

/* Makes room in the heap's array for this many more contacts. */
void contact_heap_make_room(struct contact_list *heap, uint32_t more);

void contact_heap_push(struct contact_queue *contacts, const struct contact *contact);

/* Takes the earliest contact, valid or not. The heap must not be empty. */
void contact_heap_pop(struct contact_queue *contacts);

#endif
