/* Motion of aircraft, in batches of eight as for land vehicles (ground_vehicle.h), by the formulas
 * of airframe.h. Helicopters hover (min_speed_mps 0); agents keep aeroplanes above the speed at
 * which they stall. Both keep their height above the ground ahead. All turn back before the edge of
 * the world; one that cannot crosses it.
 *
 * A batch of more than one frame moves its rows by a stretch (world/entity/cruise.h). It refuses
 * what does not fly evenly, is low, or is near the edge of the world; such rows stay as they are.
 */
#ifndef JOLON_MOVER_MOTION_AIRCRAFT_H
#define JOLON_MOVER_MOTION_AIRCRAFT_H

#include "mover/context/step_context.h"
#include "world/terrain/terrain_cache.h"

/* An aircraft wants to climb so fast for each metre that it is too low [m/s]. */
#define AIRCRAFT_FOLLOW_PS 0.8

struct aircraft {
    int count;       /* lanes taken */
    uint32_t frames; /* by which the rows move: 1, or those of a stretch */
    uint32_t row[LANE_COUNT];
    /* The desired motion. */
    union lane_masks driven, held, parked;
    union simd_lanes wanted_heading, wanted_mps, altitude, turn, climb, brake, spool, power;
    /* The row, before and after. */
    union simd_lanes x, y, z, vx, vy, vz, heading, pitch, roll, fuel;
    /* The kind. */
    union simd_lanes full_mps, least_mps, acceleration, turn_rate, climb_rate, load, burn_lps, low;
    union lane_masks tank;          /* it has one */
    union simd_lanes ground;        /* the higher of the ground under it and ahead */
    union lane_masks blocked, left; /* results: it is at the edge of the world, and beyond it */
    /* Of a stretch: how far it turns [rad], its gain of speed, and whether it is refused. */
    union simd_lanes turned, gain_mps2;
    union lane_masks refused;
    struct terrain_cache here, ahead; /* the ground under it, and where it soon will be */
    struct terrain_cache_entry idle;  /* of free lanes */
};

/* Returns true if row i flies towards an edge of the world that is near: it turns back, whatever
 * its agent or its driver wants. */
bool aircraft_turns_back(const struct step_context *context, uint32_t i);

/* Returns the ground [m] above which row i holds its height: the higher of that under it and that
 * where it will be in three seconds. */
double aircraft_ground(const struct step_context *context, uint32_t i);

/* Empties the batch. frames: by which its rows move. */
void aircraft_begin(struct aircraft *batch, uint32_t frames);

/* Gives row i a lane. True when the batch is full. */
bool aircraft_take(const struct step_context *context, struct aircraft *batch, uint32_t i,
                   const struct desired_motion *desired);

/* Moves the rows of the batch that it does not refuse; their lanes stay taken. */
void aircraft_move(const struct step_context *context, struct aircraft *batch);

#endif
