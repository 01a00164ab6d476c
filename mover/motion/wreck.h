/* Motion of wrecks: they slide and fall to rest, and turn by their spin. Nearly all of them lie
 * still, so the ground under eight at a time is compared with their heights. */
#ifndef JOLON_MOVER_MOTION_WRECK_H
#define JOLON_MOVER_MOTION_WRECK_H

#include "mover/context/step_context.h"
#include "world/terrain/terrain_cache.h"

struct wrecks {
    int count; /* lanes taken */
    uint32_t row[LANE_COUNT];
    union simd_lanes x, z;
    union simd_lanes y; /* result: the height of the ground */
    struct terrain_cache ground;
    struct terrain_cache_entry idle; /* of free lanes */
};

/* Empties the batch. */
void wrecks_begin(struct wrecks *wrecks);

/* Gives row i a lane. True when the batch is full. */
bool wrecks_take(const struct step_context *context, struct wrecks *wrecks, uint32_t i);

/* Finds the ground under the rows of the batch; their lanes stay taken. */
void wrecks_find_ground(const struct step_context *context, struct wrecks *wrecks);

/* Moves row i, a wreck over ground of this height. True when constant_course_set_down() must then
 * set it down; a wreck at rest stays as it is. */
bool wreck_row(const struct step_context *context, uint32_t i, double ground);

#endif
