/* Wrecks: they slide and fall to rest, and turn by their spin. Nearly all of them lie still, and
 * eight at a time find that the ground has not changed. */
#ifndef JOLON_MOVER_WRECK_H
#define JOLON_MOVER_WRECK_H

#include "mover/move.h"
#include "world/footing.h"

struct wrecks {
    int count; /* lanes taken */
    uint32_t row[LANE_COUNT];
    union lanes x, z;
    union lanes y; /* what comes out: the ground's height */
    struct footing ground;
    struct footing_patch idle; /* of lanes that are nobody's yet */
};

/* Without any. */
void wrecks_begin(struct wrecks *wrecks);

/* Row i takes a lane: true when that was the last. */
bool wrecks_take(const struct move *move, struct wrecks *wrecks, uint32_t i);

/* Finds the ground under those who have a lane; their lanes stay taken. */
void wrecks_find_ground(const struct move *move, struct wrecks *wrecks);

/* Moves row i, a wreck over ground of this height. True when it is then to be set on the ground as
 * hold_pose() does it: one at rest is not. */
bool wreck_row(const struct move *move, uint32_t i, double ground);

#endif
