/* What the renderer works out once about a world that stands still: where its fixed objects are by
 * gridsquare, what each looks like, and the ground's quadtree. Pure. */
#ifndef JOLON_RENDERER_SCENERY_H
#define JOLON_RENDERER_SCENERY_H

#include "renderer/scene/foliage.h"
#include "renderer/scene/ground.h"
#include "renderer/scene/mesh.h"
#include "world/square.h"
#include "world/world.h"

#include <stdint.h>

/* How a fixed object is drawn. */
#define LOOK_MODEL 255u /* by its kind's polygons; anything less is an enum foliage */

#define SCENERY_BLOCK  8u /* gridsquares a side of a block, by which plants are culled */
#define SCENERY_BLOCKS ((SQUARE_PER_SIDE + SCENERY_BLOCK - 1u) / SCENERY_BLOCK) /* a side */
#define SCENERY_LONELY 4u /* so few plants of a gridsquare are never thinned out */

/* What never changes about a fixed object that is a plant. */
struct scenery_plant {
    float width, height, sink; /* [m] sink: how deep its foot is in the ground */
    float slope[2], tint[3];   /* see struct scene_plant */
    float rank;                /* 0..1: while less than this share of a wood is shown, it is not */
    float lone;                /* share of its wood that is never thinned out */
};

/* Lowest foot and highest top of the plants of a block; low above high: it has none. */
struct scenery_block {
    float low, high;
};

struct scenery {
    const struct world *world;
    struct ground ground;
    uint32_t *square_start;       /* [SQUARE_COUNT + 1] into world->fixed; owned */
    uint8_t *look;                /* [world->counts.fixed] enum foliage or LOOK_MODEL; owned */
    struct scenery_plant *plants; /* [world->counts.fixed]; owned */
    struct scenery_block *blocks; /* [SCENERY_BLOCKS * SCENERY_BLOCKS] row by row; owned */
    struct mesh_frame *frames;    /* [world->counts.models]; owned */
};

/* 0, or -1 with errno ENOMEM. The world must outlive it. */
int scenery_init(struct scenery *scenery, const struct world *world);
void scenery_free(struct scenery *scenery);

/* Of the ground without craters: rise a metre to the east, to the south. */
void scenery_slope(const struct terrain *terrain, double x, double z, float slope[2]);

#endif
