/* One committed frame as the renderer sees it. It points into a private snapshot. Only the
 * append-only lists of craters and dents behind their indices are shared with a writer. */
#ifndef JOLON_RENDERER_SCENE_FRAME_FRAME_VIEW_H
#define JOLON_RENDERER_SCENE_FRAME_FRAME_VIEW_H

#include "renderer/scene/frame/dent_index.h"
#include "renderer/scene/frame/articulation.h"
#include "world/state.h"

#include <stdint.h>

struct crater_index;
struct entities;
struct road_index;
struct world;

struct frame_view {
    const struct world *world;
    const struct state_head *head;
    const struct entities *entities; /* rows 0 .. head->used - 1 */
    const uint8_t *fixed_damage;     /* [world->counts.fixed] enum damage */
    const struct crater_index *craters;
    const struct dent_index *dents;
    const struct road_index *roads;          /* NULL: no roads are drawn on the ground */
    const struct articulation *articulation; /* NULL: every vehicle is in its initial state */
    double ahead_s; /* simulation time of the picture after the frame's [s]; bodies are at their
                       positions at that time (renderer/scene/frame/frame_interpolation.h) */
};

/* Returns the simulation time of the picture. */
static inline double frame_view_time_s(const struct frame_view *frame_view)
{
    return state_time_s(frame_view->world, frame_view->head) + frame_view->ahead_s;
}

#endif
