/* A moment: one committed frame as the renderer sees it. Views of a private snapshot; nothing here
 * is shared with a writer but the append-only lists of craters and dents behind their indices. */
#ifndef JOLON_RENDERER_MOMENT_H
#define JOLON_RENDERER_MOMENT_H

#include "renderer/scene/dents.h"
#include "world/world.h"

#include <stdint.h>

struct moment {
    const struct world *world;
    const struct state_head *head;
    const struct entities *entities; /* rows 0 .. head->used - 1 */
    const uint8_t *fixed_damage;     /* [world->counts.fixed] enum damage */
    const struct crater_index *craters;
    const struct dents *dents;
};

#endif
