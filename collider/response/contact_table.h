/* The table of persistent contacts from frame to frame: which pairs the committed frame knows, and
 * the next frame's table. Pure; one caller, and its workers. */
#ifndef JOLON_COLLIDER_RESPONSE_CONTACT_TABLE_H
#define JOLON_COLLIDER_RESPONSE_CONTACT_TABLE_H

#include "collider/response/response_context.h"

#include <stdbool.h>
#include <stdint.h>

/* A contact whose bodies have not touched for this time has ended [s]. A vehicle that scrapes along
 * another touches it more often. */
#define CONTACT_TABLE_LASTS_S 0.25

/* It has not ended while its bodies are this near [m]. At a low frame rate the way of one frame
 * makes a body touch another, and the guard then puts it back by that way. In a heap that presses,
 * bodies come some centimetres apart and touch again. */
#define CONTACT_TABLE_PARTED_M 0.15

/* The key of a contact as two words, in the order of the table. */
struct contact_key {
    uint32_t a_id, b_id;
};

/* How far the bodies of a contact of the committed table are apart at the frame's end. */
struct contact_gap {
    uint32_t contact; /* index */
    double gap_m;     /* beyond CONTACT_TABLE_PARTED_M it is a lower bound above that */
};

/* The pairs that touched in this frame, by their keys; the collider's own memory. */
struct contact_table {
    struct contact_key *key;
    uint32_t *pair; /* [count] their indices in the queue, in its order */
    struct persistent_contact *touched;
    uint32_t count, capacity;
    struct contact_gap *gap; /* of known contacts without a load whose bodies move */
    uint32_t gaps;
};

/* Returns 0, or -1 with errno ENOMEM. */
int contact_table_init(struct contact_table *table, const struct world *world);
void contact_table_free(struct contact_table *table);

/* Returns the pair's row in the committed table, or NULL. b: a row, or a fixed object with
 * PAIR_FIXED. */
const struct persistent_contact *contact_table_find(const struct response_context *context,
                                                    uint32_t a, uint32_t b);

/* Returns true if this side of a contact lets others pass through it under the scenario's response:
 * b is a row, or a fixed object with PAIR_FIXED. */
bool contact_table_lets_through(const struct response_context *context, uint32_t b);

/* Takes room for the contact of a pair that the committed table does not know and that has not
 * touched in this frame: pair is its index + 1 in the queue. Returns true if the beginning has to
 * be told: there is room, or there is none for the first time in this simulated second. Room is
 * what the committed table leaves; what ends in this frame leaves room in the next. */
bool contact_table_begins(struct response_context *context, uint32_t pair);

/* Makes the next frame's table from the committed one and the pairs that are marked as
 * CONTACT_PRESSED. Bodies that pass through each other are in contact for as long as they overlap.
 * Gaps are measured on all workers. Writes an event for each contact that has ended, and for one
 * without room whose beginning was told. */
void contact_table_finish(struct contact_table *table, struct response_context *context);

#endif
