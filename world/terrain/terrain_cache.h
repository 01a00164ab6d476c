/* The ground under LANE_COUNT bodies at once, from a few posts cached for each. Pure; any
 * thread. */
#ifndef JOLON_WORLD_TERRAIN_TERRAIN_CACHE_H
#define JOLON_WORLD_TERRAIN_TERRAIN_CACHE_H

#include "world/maths/simd.h"
#include "world/terrain/terrain.h"

#include <stdbool.h>

/* The posts about a body, copied together. Bodies in neighbouring rows are far apart on the ground,
 * so the posts themselves are rarely in the processor's cache. Zero at first; kept with the body.
 */
#define TERRAIN_CACHE_SIDE 3
struct terrain_cache_entry {
    uint16_t column, row; /* of its first post, the north-west one */
    uint16_t water;       /* bit i: there is water around post i */
    uint16_t held;        /* 1: the entry is filled */
    float post[TERRAIN_CACHE_SIDE * TERRAIN_CACHE_SIDE];
    float bend; /* by how much the slopes between the posts differ at most, as a tangent */
};

/* The entries of the bodies. The terrain has at least TERRAIN_CACHE_SIDE posts a side. */
struct terrain_cache {
    struct terrain_cache_entry
        *patch[LANE_COUNT];       /* of each lane; an unused lane may have any entry */
    union lane_cells column, row; /* of the entries */
};

/* Fills the entries with the posts about (x, z). */
void terrain_cache_find(const struct terrain *terrain, struct terrain_cache *cache,
                        const union simd_lanes *x, const union simd_lanes *z);

/* Height of the uncratered ground [m], with its earthworks, at a point of each body, equal to
 * terrain_base_height() to the bit. Fast if the entry has the posts. */
void terrain_cache_heights(const struct terrain *terrain, const struct terrain_cache *cache,
                           const union simd_lanes *x, const union simd_lanes *z,
                           union simd_lanes *height);

/* Returns true only if there is no water at any point that is at most reach_m [m, each 0 or more]
 * east or west and as far north or south of the point for which a lane's entry was last found. It
 * costs less than to ask for the water. */
bool terrain_cache_dry(const struct terrain *terrain, const struct terrain_cache *cache,
                       const union simd_lanes *reach_m);

/* Finds by how much the slopes of the ground about each body differ at most, as a tangent. */
void terrain_cache_bends(const struct terrain_cache *cache, union simd_lanes *bend);

/* Returns the same for one body at (x, z). Fills its entry with the posts about it. */
double terrain_cache_bend(const struct terrain *terrain, struct terrain_cache_entry *entry,
                          double x, double z);

/* Finds the slopes to the east and to the south of the ground at a point as terrain_base_plane()
 * does, to the bit. Fast if the entry of a body near has the posts; it does not change. */
void terrain_cache_slopes(const struct terrain *terrain, const struct terrain_cache_entry *entry,
                          double x, double z, double *east, double *south);

/* Whether there is water at a point of each body, as by terrain_cover(). Fast if the entry has the
 * posts. */
void terrain_cache_water(const struct terrain *terrain, const struct terrain_cache *cache,
                         const union simd_lanes *x, const union simd_lanes *z,
                         union lane_masks *water);

#endif
