/* Axes that kept pairs of bodies apart a frame ago. Most still do, so they are tried first. The
 * memory belongs to one process. An axis is a proof only where it separates the bodies, so that no
 * result depends on what is remembered. One thread. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_AXIS_MEMORY_H
#define JOLON_COLLIDER_NARROW_PHASE_AXIS_MEMORY_H

#include "collider/motion/pair_filter.h"

struct world;

struct remembered_axis {
    struct pair pair;
    struct vec3 axis; /* unit, from a to b; 0: none */
    uint32_t failed;  /* in so many searches no axis has been found since one was */
    uint32_t unused;
};

struct axis_memory {
    struct remembered_axis *entry; /* [mask + 1] by hashes of pairs; a later pair replaces one */
    uint32_t mask;
};

/* Returns 0, or -1 with errno ENOMEM. */
int axis_memory_init(struct axis_memory *memory, const struct world *world);
void axis_memory_free(struct axis_memory *memory);

/* Returns what is remembered of the pair; without memory no axis and no failure. */
struct remembered_axis axis_memory_recall(const struct axis_memory *memory,
                                          const struct pair *pair);

void axis_memory_keep(struct axis_memory *memory, const struct remembered_axis *axis);

#endif
