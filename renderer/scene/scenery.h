/* What the renderer works out once about a world that stands still: where its fixed objects are by
 * gridsquare, what each looks like, and the ground's quadtree. Pure. */
#ifndef JOLON_RENDERER_SCENERY_H
#define JOLON_RENDERER_SCENERY_H

#include "renderer/scene/foliage.h"
#include "renderer/scene/ground.h"
#include "renderer/scene/mesh.h"
#include "world/world.h"

#include <stdint.h>

/* How a fixed object is drawn. */
#define LOOK_MODEL 255u /* by its kind's polygons; anything less is an enum foliage */

struct scenery {
    const struct world *world;
    struct ground ground;
    uint32_t *square_start;    /* [SQUARE_COUNT + 1] into world->fixed; owned */
    uint8_t *look;             /* [world->counts.fixed] enum foliage or LOOK_MODEL; owned */
    struct mesh_frame *frames; /* [world->counts.models]; owned */
};

/* 0, or -1 with errno ENOMEM. The world must outlive it. */
int scenery_init(struct scenery *scenery, const struct world *world);
void scenery_free(struct scenery *scenery);

#endif
