/* Wrecks: they slide and fall to rest, and turn by their spin. Nearly all of them lie still, and
 * eight at a time find that the ground has not changed. */
#ifndef JOLON_MOVER_MOTION_WRECK_H
#define JOLON_MOVER_MOTION_WRECK_H

#include "mover/context/step_context.h"
#include "world/terrain/terrain_cache.h"

struct wrecks {
    int count; /* lanes taken */
    uint32_t row[LANE_COUNT];
    union simd_lanes x, z;
    union simd_lanes y; /* what comes out: the ground's height */
    struct terrain_cache ground;
    struct terrain_cache_entry idle; /* of lanes that are nobody's yet */
};

/* Without any. */
void wrecks_begin(struct wrecks *wrecks);

/* Row i takes a lane: true when that was the last. */
bool wrecks_take(const struct step_context *context, struct wrecks *wrecks, uint32_t i);

/* Finds the ground under those who have a lane; their lanes stay taken. */
void wrecks_find_ground(const struct step_context *context, struct wrecks *wrecks);

/* Moves row i, a wreck over ground of this height. True when it is then to be set on the ground as
 * constant_course_set_down() does it: one at rest is not. */
bool wreck_row(const struct step_context *context, uint32_t i, double ground);

#endif
