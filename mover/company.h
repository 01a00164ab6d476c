/* Company: who is about those that think in this frame, gathered place by place.
 *
 * Whoever looks ahead looks at everybody about it. One after the other in the order of their rows,
 * lookers come from all over the map and find nothing of its index in the cache; in the order of
 * its cells each finds what the one before it has just read. So they are gathered in that order,
 * and the look reads a short list. A look that finds no list asks the index itself, and sees the
 * same. */
#ifndef JOLON_MOVER_COMPANY_H
#define JOLON_MOVER_COMPANY_H

#include "mover/near.h"

struct avoid;

struct company_list {
    uint32_t first, count; /* of entries; count COMPANY_NONE: none was made */
};

#define COMPANY_NONE UINT32_MAX

struct company {
    uint32_t capacity;
    struct near_entry *entries; /* each row of cells has room by how many vehicles it has */
    struct company_list *list;  /* [capacity] of rows whose entry says that they are due */
};

/* 0, or -1 with errno ENOMEM. */
int company_init(struct company *company, uint32_t capacity);
void company_free(struct company *company);

/* Gathers for all whose entry is due, from the index of this frame. workers may be NULL. */
void company_gather(struct company *company, const struct near *near, const struct world *world,
                    const struct avoid *avoid, struct workers *workers);

#endif
