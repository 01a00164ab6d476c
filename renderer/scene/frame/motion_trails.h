/* Where entities lately were: what they leave behind lies along it. Noted from moments as they are
 * seen; a bounded memory by slot. Pure. */
#ifndef JOLON_RENDERER_SCENE_FRAME_MOTION_TRAILS_H
#define JOLON_RENDERER_SCENE_FRAME_MOTION_TRAILS_H

#include "renderer/scene/frame/frame_view.h"

#include <stdbool.h>
#include <stdint.h>

#define MOTION_TRAILS_SLOTS 4096u /* entities in higher slots are taken to have come straight */
#define MOTION_TRAIL_POINTS 12u

struct motion_trail_point {
    float at[3], velocity[3]; /* [m, world], [m/s] */
    double time_s;            /* of simulation */
};

/* Of one entity, and how it fared; the points' ring holds the last MOTION_TRAIL_POINTS. */
struct motion_trail {
    uint32_t id; /* 0: nobody's */
    uint32_t count;
    uint16_t kind;
    bool wrecked;    /* it was seen to be one */
    double smokes_s; /* since when it smokes, of simulation; INFINITY: it does not */
    struct motion_trail_point point[MOTION_TRAIL_POINTS];
};

struct motion_trails {
    struct motion_trail trail[MOTION_TRAILS_SLOTS]; /* by slot */
};

/* Notes where everything is whose way will show. Called for a moment again it changes nothing. */
void motion_trails_note(struct motion_trails *trails, const struct frame_view *frame_view);

/* A munition's last place, from its detonation. */
void motion_trails_end(struct motion_trails *trails, uint32_t id, const double point[3],
                       double time_s);

/* The slot's trail if it belongs to this entity, else NULL. */
const struct motion_trail *motion_trails_of(const struct motion_trails *trails, uint32_t slot,
                                            uint32_t id);

/* Where the entity was at a time, on a smooth curve through the points up to now, at a moment when
 * it was there. From before the first point on it came straight. */
struct motion_trail_point motion_trail_at(const struct motion_trail *trail,
                                          const struct motion_trail_point *now, double time_s);

/* How fast it was at its points since a time, and is now [m/s]. */
double motion_trail_fastest_mps(const struct motion_trail *trail,
                                const struct motion_trail_point *now, double since_s);

#endif
