/* Aircraft, eight at a time, as land vehicles are (ground_vehicle.h). */
#ifndef JOLON_MOVER_MOTION_AIRCRAFT_H
#define JOLON_MOVER_MOTION_AIRCRAFT_H

#include "mover/context/step_context.h"
#include "world/terrain/terrain_cache.h"

struct aircraft {
    int count; /* lanes taken */
    uint32_t row[LANE_COUNT];
    union lane_masks driven; /* of the wish */
    union simd_lanes wanted_heading, wanted_mps, altitude, turn, climb, brake;
    union simd_lanes x, y, z, vx, vy, vz, heading, pitch, roll,
        fuel; /* of the row, before and after */
    union simd_lanes full_mps, least_mps, acceleration, turn_rate, climb_rate,
        burn_lps; /* of its kind */
    union lane_masks tank;
    union lane_masks blocked;         /* what comes out: it is at the world's edge */
    struct terrain_cache here, ahead; /* the ground under it, and where it soon will be */
    struct terrain_cache_entry idle;  /* of lanes that are nobody's yet */
};

/* Without anybody. */
void aircraft_begin(struct aircraft *batch);

/* Row i, by its wish, takes a lane: true when that was the last. */
bool aircraft_take(const struct step_context *context, struct aircraft *batch, uint32_t i,
                   const struct desired_motion *desired);

/* Moves those who have a lane; their lanes stay taken. */
void aircraft_move(const struct step_context *context, struct aircraft *batch);

#endif
