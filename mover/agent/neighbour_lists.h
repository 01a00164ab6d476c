/* A list of neighbours for each agent that decides in this frame.
 *
 * Agents that follow each other in the table are far from each other on the map, so that each would
 * read other parts of the index, which are not in the processor's cache. The lists are gathered in
 * the order of the index's cells. Each look-up then reads entries that the previous one has put
 * into the cache. An agent without a list queries the index and finds the same vehicles. */
#ifndef JOLON_MOVER_AGENT_NEIGHBOUR_LISTS_H
#define JOLON_MOVER_AGENT_NEIGHBOUR_LISTS_H

#include "mover/query/neighbour_index.h"

struct avoidance;
struct world;

struct neighbour_list {
    uint32_t first, count; /* entries; count NEIGHBOUR_LISTS_NONE: there was no room for the list */
};

#define NEIGHBOUR_LISTS_NONE UINT32_MAX

struct neighbour_lists {
    uint32_t capacity;
    struct neighbour_index_entry *entries; /* of all lists */
    /* [capacity] Set for the rows that decide in their turn (step_context_thinks()); that of any
     * other row may be an old one. */
    struct neighbour_list *list;
};

/* 0, or -1 with errno ENOMEM. */
int neighbour_lists_init(struct neighbour_lists *lists, uint32_t capacity);
void neighbour_lists_free(struct neighbour_lists *lists);

/* Takes the memory for this many rows before a step needs it. */
void neighbour_lists_touch(const struct neighbour_lists *lists, uint32_t rows);

/* Gathers the lists of all rows whose entry is due. Notes in the index which rows of cells have no
 * agent that decides. ahead_m: how much further away than its farthest look an entry is held that
 * may be in it (avoidance_ahead()). workers may be NULL. */
void neighbour_lists_gather(struct neighbour_lists *lists, struct neighbour_index *index,
                            const struct world *world, const struct avoidance *avoidance,
                            double ahead_m, struct thread_pool *workers);

/* Notes that the row has no list until its entry is due again. */
static inline void neighbour_lists_none(struct neighbour_lists *lists, uint32_t row)
{
    lists->list[row].count = NEIGHBOUR_LISTS_NONE;
}

#endif
