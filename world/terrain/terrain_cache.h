/* The ground under bodies, a lane each. Pure; any thread. */
#ifndef JOLON_WORLD_TERRAIN_TERRAIN_CACHE_H
#define JOLON_WORLD_TERRAIN_TERRAIN_CACHE_H

#include "world/maths/simd.h"
#include "world/terrain/terrain.h"

/* Posts about a body, copied together: the ground itself is rarely in a cache, and bodies that
 * stand in a row of a table are all over it. Begins as zeros; kept by whoever moves the body. */
#define TERRAIN_CACHE_SIDE 3
struct terrain_cache_entry {
    uint16_t column, row; /* of its first post, the north-west one */
    uint16_t water;       /* bit i: there is water about post i */
    uint16_t held;        /* it holds what it says */
    float post[TERRAIN_CACHE_SIDE * TERRAIN_CACHE_SIDE];
};

/* Bodies and their patches. The square is of three posts a side at least. */
struct terrain_cache {
    struct terrain_cache_entry *patch[LANE_COUNT]; /* each lane its own, idle ones some other */
    union lane_cells column, row;                  /* of the patches */
};

/* Makes the patches those about (x, z). */
void terrain_cache_find(const struct terrain *terrain, struct terrain_cache *cache,
                        const union simd_lanes *x, const union simd_lanes *z);

/* Height of the uncratered ground [m] at a point of each body, to the bit terrain_base_height();
 * and whether there is water, as terrain_cover() says. Fast where the point is in its patch. */
void terrain_cache_heights(const struct terrain *terrain, const struct terrain_cache *cache,
                           const union simd_lanes *x, const union simd_lanes *z,
                           union simd_lanes *height);
void terrain_cache_water(const struct terrain *terrain, const struct terrain_cache *cache,
                         const union simd_lanes *x, const union simd_lanes *z,
                         union lane_masks *water);

#endif
