/* Ground vehicles, eight at a time: each fills a lane with what it wishes, then all of them move.
 * What a vehicle does depends on nothing in the other lanes. */
#ifndef JOLON_MOVER_MOTION_GROUND_VEHICLE_H
#define JOLON_MOVER_MOTION_GROUND_VEHICLE_H

#include "mover/motion/ground_pose.h"

struct ground_vehicle {
    int count; /* lanes taken */
    uint32_t row[LANE_COUNT];
    bool out_of_gear[LANE_COUNT];
    union lane_masks held; /* its wish is what its controls ask: turn and wanted_mps are these */
    union lane_masks driven, low_gear; /* of the wish */
    union simd_lanes wanted_heading, wanted_mps, turn, brake;
    union simd_lanes y, vx, vz, heading, pitch, fuel; /* of the row, before and after */
    union simd_lanes full_mps, acceleration, turn_rate, max_slope, half_length,
        burn_lps;             /* of its kind */
    union lane_masks tank;    /* it has one */
    union simd_lanes debris;  /* share of full speed that what fell here allows */
    union lane_masks blocked; /* what comes out: the way is: water, a slope, the world's edge */
    struct ground_pose pose;  /* with its place */
};

/* Without anybody. */
void ground_vehicle_begin(struct ground_vehicle *batch);

/* Row i, by its wish, takes a lane: true when that was the last. */
bool ground_vehicle_take(const struct step_context *context, struct ground_vehicle *batch,
                         uint32_t i, const struct desired_motion *desired);

/* The same by its controls as its agent set them: what agent_controls_motion() would wish. */
bool ground_vehicle_take_held(const struct step_context *context, struct ground_vehicle *batch,
                              uint32_t i);

/* Moves those who have a lane; their lanes stay taken, so that the caller can see who is blocked.
 */
void ground_vehicle_move(const struct step_context *context, struct ground_vehicle *batch);

#endif
