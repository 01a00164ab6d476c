/* Random earthworks for tests. */
#ifndef JOLON_TESTS_SUPPORT_WORKS_H
#define JOLON_TESTS_SUPPORT_WORKS_H

#include "world/terrain/earthwork.h"

/* Draws works of all shapes and sizes with their middles between low and high on both axes [m],
 * many on top of one another. No height is more than 3 m, and no slope shorter than edge_m. */
void works_scatter(struct earthwork *works, uint32_t count, double low, double high, double edge_m,
                   uint64_t *random);

/* Returns the works with an index on the heap, which works_free() frees. */
struct earthworks works_index(const struct earthwork *works, uint32_t count);
void works_free(struct earthworks *works);

#endif
