/* Recent positions of entities, along which dust, wakes and smoke lie. They are taken from frames
 * as they are seen; the memory is bounded, by slot. Pure. */
#ifndef JOLON_RENDERER_SCENE_FRAME_MOTION_TRAILS_H
#define JOLON_RENDERER_SCENE_FRAME_MOTION_TRAILS_H

#include "renderer/scene/frame/frame_view.h"

#include <stdbool.h>
#include <stdint.h>

#define MOTION_TRAILS_SLOTS 4096u /* entities in higher slots have no trail */
#define MOTION_TRAIL_POINTS 12u

struct motion_trail_point {
    float at[3], velocity[3]; /* [m, world], [m/s] */
    double time_s;            /* of simulation */
};

/* The trail of one entity, and its damage. A ring of the last MOTION_TRAIL_POINTS points. */
struct motion_trail {
    uint32_t id; /* 0: none */
    uint32_t count;
    uint16_t kind;
    bool wrecked;    /* it was already seen as a wreck */
    bool broken;     /* ... that has broken up */
    double smokes_s; /* simulation time since when it smokes; INFINITY: it does not */
    struct motion_trail_point point[MOTION_TRAIL_POINTS];
};

struct motion_trails {
    struct motion_trail trail[MOTION_TRAILS_SLOTS]; /* by slot */
};

/* Adds the positions of all entities that leave trails. Calling it twice with one frame changes
 * nothing. */
void motion_trails_note(struct motion_trails *trails, const struct frame_view *frame_view);

/* Adds the last position of a munition, from its detonation. */
void motion_trails_end(struct motion_trails *trails, uint32_t id, const double point[3],
                       double time_s);

/* Returns the trail of the slot, or NULL if the trail is that of another entity. */
const struct motion_trail *motion_trails_of(const struct motion_trails *trails, uint32_t slot,
                                            uint32_t id);

/* Returns position and velocity at a time, on a smooth curve through the points up to now. Before
 * the first point the motion is a straight line. now: the entity's present state. */
struct motion_trail_point motion_trail_at(const struct motion_trail *trail,
                                          const struct motion_trail_point *now, double time_s);

/* Returns the highest speed at the points since a time, and now [m/s]. */
double motion_trail_fastest_mps(const struct motion_trail *trail,
                                const struct motion_trail_point *now, double since_s);

#endif
