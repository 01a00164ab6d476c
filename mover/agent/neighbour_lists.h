/* Company: who is about those that think in this frame, gathered place by place.
 *
 * Whoever looks ahead looks at everybody about it. One after the other in the order of their rows,
 * lookers come from all over the map and find nothing of its index in the cache; in the order of
 * its cells each finds what the one before it has just read. So they are gathered in that order,
 * and the look reads a short list. A look that finds no list asks the index itself, and sees the
 * same. */
#ifndef JOLON_MOVER_AGENT_NEIGHBOUR_LISTS_H
#define JOLON_MOVER_AGENT_NEIGHBOUR_LISTS_H

#include "mover/query/neighbour_index.h"

struct avoidance;
struct world;

struct neighbour_list {
    uint32_t first, count; /* of entries; count NEIGHBOUR_LISTS_NONE: none was made */
};

#define NEIGHBOUR_LISTS_NONE UINT32_MAX

struct neighbour_lists {
    uint32_t capacity;
    struct neighbour_index_entry
        *entries;                /* each row of cells has room by how many vehicles it has */
    struct neighbour_list *list; /* [capacity] of rows whose entry says that they are due */
};

/* 0, or -1 with errno ENOMEM. */
int neighbour_lists_init(struct neighbour_lists *lists, uint32_t capacity);
void neighbour_lists_free(struct neighbour_lists *lists);

/* Gathers for all whose entry is due, from the index of this frame. workers may be NULL. */
void neighbour_lists_gather(struct neighbour_lists *lists, const struct neighbour_index *index,
                            const struct world *world, const struct avoidance *avoidance,
                            struct thread_pool *workers);

#endif
