/* Aircraft, eight at a time, as land vehicles are (land.h). */
#ifndef JOLON_MOVER_AIR_H
#define JOLON_MOVER_AIR_H

#include "mover/move.h"
#include "world/footing.h"

struct air {
    int count; /* lanes taken */
    uint32_t row[LANE_COUNT];
    union lane_masks driven; /* of the wish */
    union lanes wanted_heading, wanted_mps, altitude, turn, climb, brake;
    union lanes x, y, z, vx, vy, vz, heading, pitch, roll, fuel; /* of the row, before and after */
    union lanes full_mps, least_mps, acceleration, turn_rate, climb_rate,
        burn_lps; /* of its kind */
    union lane_masks tank;
    union lane_masks blocked;   /* what comes out: it is at the world's edge */
    struct footing here, ahead; /* the ground under it, and where it soon will be */
    struct footing_patch idle;  /* of lanes that are nobody's yet */
};

/* Without anybody. */
void air_begin(struct air *air);

/* Row i, by its wish, takes a lane: true when that was the last. */
bool air_take(const struct move *move, struct air *air, uint32_t i, const struct wish *wish);

/* Moves those who have a lane; their lanes stay taken. */
void air_move(const struct move *move, struct air *air);

#endif
