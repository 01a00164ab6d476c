/* The table of persistent contacts from frame to frame: which pairs the committed frame knows, and
 * the next frame's table. Pure; one thread. */
#ifndef JOLON_COLLIDER_RESPONSE_CONTACT_TABLE_H
#define JOLON_COLLIDER_RESPONSE_CONTACT_TABLE_H

#include "collider/response/response_context.h"

#include <stdbool.h>
#include <stdint.h>

/* A contact whose bodies have not touched for this time has ended [s]. A vehicle that scrapes along
 * another touches it more often. */
#define CONTACT_TABLE_LASTS_S 0.25

/* The pairs that touched in this frame; the collider's own memory. */
struct contact_table {
    struct persistent_contact *touched;
    uint32_t count, capacity;
};

/* Returns 0, or -1 with errno ENOMEM. */
int contact_table_init(struct contact_table *table, const struct world *world);
void contact_table_free(struct contact_table *table);

/* Returns true if the pair is in contact: it touched in this frame before, or is in the committed
 * table. pair: its index + 1 in the queue, 0 for none. */
bool contact_table_knows(const struct response_context *context, uint32_t a, uint32_t b,
                         uint32_t pair);

/* Makes the next frame's table from the committed one and the pairs that are marked as
 * CONTACT_PRESSED. Writes an event for each contact that has ended. */
void contact_table_finish(struct contact_table *table, struct response_context *context);

#endif
