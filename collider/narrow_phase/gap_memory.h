/* How far apart bodies were when they were last measured. Bodies that have come less far since then
 * are still apart. So near bodies that no axis separates, such as a gun over a deck, are measured
 * once in some frames. The memory belongs to one process. It holds bounds of gaps, so that no
 * result depends on what is remembered. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_GAP_MEMORY_H
#define JOLON_COLLIDER_NARROW_PHASE_GAP_MEMORY_H

#include "collider/geometry/time_of_impact.h"
#include "collider/motion/pair_filter.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

struct world;

/* What the hulls of a body are, and where its turret and gun point. */
struct remembered_shape {
    const struct hull *hull;
    double scale, turret, gun;
};

/* Two bodies in one place. */
struct remembered_gap {
    struct pair pair; /* a and b are 0: none */
    uint64_t frame;   /* of the memory's own count */
    struct remembered_shape a, b;
    struct quat turn_a, turn_b;
    struct vec3 between;    /* [m] from a's position to b's */
    double least_m, most_m; /* bounds of the gap there; most_m may be INFINITY */
};

struct gap_memory {
    struct remembered_gap *entry; /* [mask + 1] by hashes of pairs; a later pair replaces one */
    uint32_t mask;
    struct remembered_gap *fresh; /* [mask + 1] the frame's, in no order */
    _Atomic uint32_t fresh_count; /* may be more: there was no room for the last ones */
    uint64_t frame;
};

/* Bounds of a gap [m]. */
struct gap_bounds {
    double least_m, most_m;
};

/* Returns 0, or -1 with errno ENOMEM. */
int gap_memory_init(struct gap_memory *memory, const struct world *world);
void gap_memory_free(struct gap_memory *memory);

/* Returns bounds of the gap of two bodies where their paths begin: 0 and INFINITY without memory.
 * The first body is that of pair->a. Any thread. */
struct gap_bounds gap_memory_recall(const struct gap_memory *memory, const struct pair *pair,
                                    const struct swept_body *a, const struct swept_body *b);

/* Returns true unless the pair was measured a few frames ago: a gap of bodies so fast would last no
 * longer. Any thread. */
bool gap_memory_wants(const struct gap_memory *memory, const struct pair *pair);

/* Notes the gap of two bodies where their paths begin, measured up to far_m: a greater one is
 * unknown. It is remembered from the next frame on. Any thread. */
void gap_memory_note(struct gap_memory *memory, const struct pair *pair, const struct swept_body *a,
                     const struct swept_body *b, double gap_m, double far_m);

/* The frame is over. One thread. */
void gap_memory_settle(struct gap_memory *memory);

#endif
