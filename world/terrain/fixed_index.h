/* The index of fixed objects: which of them overlap each gridsquare (thesis row 37). Built once, at
 * creation. */
#ifndef JOLON_WORLD_TERRAIN_FIXED_INDEX_H
#define JOLON_WORLD_TERRAIN_FIXED_INDEX_H

#include "world/terrain/fixed.h"
#include "world/entity/kind.h"
#include "world/maths/maths.h"
#include "world/terrain/gridsquare.h"

#include <stdint.h>

/* Returns how far an upright body reaches from its position on the map at most [m], with either
 * shape: the sphere or the hulls. */
static inline double fixed_index_of_kind(const struct kind *kind)
{
    return maths_max(kind->radius_m, kind->level_m);
}

/* The same for a fixed object. Sizes of objects vary about the size of their kind. */
static inline double fixed_index_of_fixed(const struct fixed_object *object,
                                          const struct kind *kinds)
{
    const struct kind *kind = &kinds[object->kind];
    return kind->level_m > kind->radius_m ? kind->level_m * fixed_scale(object, kind)
                                          : (double)object->radius_m;
}

/* Builds start [squares->count + 1] and items [start[squares->count]] on the heap; the caller
 * frees both. Objects ascend within a square. kinds are the objects'. 0, or -1 with errno ENOMEM.
 */
int fixed_index_build(const struct gridsquares *squares, const struct fixed_object *objects,
                      uint32_t count, const struct kind *kinds, uint32_t **start, uint32_t **items);

#endif
