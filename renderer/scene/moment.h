/* A moment: one committed frame as the renderer sees it. Views of a private snapshot; nothing here
 * is shared with a writer but the append-only lists of craters and dents behind their indices. */
#ifndef JOLON_RENDERER_MOMENT_H
#define JOLON_RENDERER_MOMENT_H

#include "renderer/scene/dents.h"
#include "renderer/scene/gear.h"
#include "world/world.h"

#include <stdint.h>

struct moment {
    const struct world *world;
    const struct state_head *head;
    const struct entities *entities; /* rows 0 .. head->used - 1 */
    const uint8_t *fixed_damage;     /* [world->counts.fixed] enum damage */
    const struct crater_index *craters;
    const struct dents *dents;
    const struct gear *gear; /* NULL: all is as in the first picture */
    double ahead_s; /* the picture's time after the frame's [s of simulation]; bodies are where they
                       are then (renderer/scene/blend.h) */
};

/* Time of simulation in the picture. */
static inline double moment_time_s(const struct moment *moment)
{
    return world_time_s(moment->world, moment->head) + moment->ahead_s;
}

#endif
