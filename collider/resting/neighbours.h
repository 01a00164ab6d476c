/* The neighbours of bodies that part: all pairs within reach of a body that is displaced, whether
 * they are in the table of contacts or not, so that nobody is pushed into a third. Those that a
 * neighbour touches may be pushed with it, and so belong to the neighbourhood, too. Pure; one
 * caller. */
#ifndef JOLON_COLLIDER_RESTING_NEIGHBOURS_H
#define JOLON_COLLIDER_RESTING_NEIGHBOURS_H

#include "collider/resting/contact_groups.h"

#include <stdbool.h>

struct world;

/* The collider's own memory. */
struct neighbours {
    uint32_t *row; /* bodies that part or may be pushed */
    uint32_t count, looked;
    uint8_t *listed; /* [capacity of the world] 1: in row */
};

/* Returns 0, or -1 with errno ENOMEM. */
int neighbours_init(struct neighbours *neighbours, const struct world *world);
void neighbours_free(struct neighbours *neighbours);

/* Forgets the bodies of the frame before. */
void neighbours_begin(struct neighbours *neighbours);

/* Adds the bodies of a pair. */
void neighbours_add(struct neighbours *neighbours, const struct pair *pair);

/* Returns true if one of the pair's bodies was added. */
bool neighbours_has(const struct neighbours *neighbours, const struct pair *pair);

/* Appends to the groups' list the pairs of the bodies added since the last call with all that are
 * within the reach of their boxes [m], in the order of their rows. Pairs that were marked are left
 * out, and all are marked. Returns false if there is none. */
bool neighbours_list(struct neighbours *neighbours, struct response_context *context,
                     double reach_m, struct contact_groups *groups);

/* Removes the marks of all pairs. */
void neighbours_unmark(struct response_context *context);

#endif
