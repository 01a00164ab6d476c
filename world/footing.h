/* The ground under bodies, a lane each. Pure; any thread. */
#ifndef JOLON_WORLD_FOOTING_H
#define JOLON_WORLD_FOOTING_H

#include "world/lanes.h"
#include "world/terrain.h"

/* Posts about a body, copied together: the ground itself is rarely in a cache, and bodies that
 * stand in a row of a table are all over it. Begins as zeros; kept by whoever moves the body. */
#define FOOTING_SIDE 3
struct footing_patch {
    uint16_t column, row; /* of its first post, the north-west one */
    uint16_t water;       /* bit i: there is water about post i */
    uint16_t held;        /* it holds what it says */
    float post[FOOTING_SIDE * FOOTING_SIDE];
};

/* Bodies and their patches. The square is of three posts a side at least. */
struct footing {
    struct footing_patch *patch[LANE_COUNT]; /* each lane its own, idle ones some other */
    union lane_cells column, row;            /* of the patches */
};

/* Makes the patches those about (x, z). */
void footing_find(const struct terrain *terrain, struct footing *footing, const union lanes *x,
                  const union lanes *z);

/* Height of the uncratered ground [m] at a point of each body, to the bit terrain_base_height();
 * and whether there is water, as terrain_cover() says. Fast where the point is in its patch. */
void footing_heights(const struct terrain *terrain, const struct footing *footing,
                     const union lanes *x, const union lanes *z, union lanes *height);
void footing_water(const struct terrain *terrain, const struct footing *footing,
                   const union lanes *x, const union lanes *z, union lane_masks *water);

#endif
