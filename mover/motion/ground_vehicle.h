/* Motion of land vehicles, in batches of eight: each row takes a lane, then all lanes move. The
 * result of a lane does not depend on the other lanes. Vehicles follow the terrain; slopes and
 * debris limit their speed, and water stops them. */
#ifndef JOLON_MOVER_MOTION_GROUND_VEHICLE_H
#define JOLON_MOVER_MOTION_GROUND_VEHICLE_H

#include "mover/motion/ground_pose.h"
#include "world/terrain/rest_pose.h"

struct ground_vehicle {
    int count;       /* lanes taken */
    uint32_t frames; /* by which the rows move: 1, or those of a stretch (world/entity/cruise.h) */
    uint32_t row[LANE_COUNT];
    union lane_masks held; /* turn and wanted_mps are the row's controls (steer, throttle) */
    /* The desired motion. */
    union simd_lanes wanted_heading, wanted_mps, turn;
    /* The row, before and after; its place is in pose. */
    union simd_lanes y, vx, vz, heading, pitch, fuel;
    struct ground_pose pose;
    /* The kind. */
    union simd_lanes full_mps, acceleration, turn_rate, max_slope, half_length, burn_lps,
        idle_share;
    union simd_lanes power_wpkg, gears, rolling, lateral; /* drivetrain.h */
    union simd_lanes curve;  /* [1/m] of the tightest circle of wheels */
    union simd_lanes pivot;  /* [rad/s] by which tracks turn it at rest */
    union simd_lanes bend;   /* chassis_shell_bend() */
    union lane_masks tank;   /* it has one */
    union simd_lanes burns;  /* frames whose fuel it burns (kinematics_burn_frames()) */
    union simd_lanes debris; /* the share of full speed that debris at its place allows */
    union lane_masks rough;  /* result: it leaves the ground that it follows */
    union lane_masks slides; /* rough, because its tyres do not hold it on a slope */
    union lane_masks walled; /* rough, and its place would be in the ground: it keeps the old one */
    union lane_masks wades;  /* it comes to water too fast for its brakes */
    union lane_masks blocked;   /* result: water, a slope or the edge of the world blocks it */
    union lane_masks tight;     /* it turns in its tightest circle, and less than by its speeds */
    union lane_masks reaches;   /* it has the speed that it wants */
    union simd_lanes turned;    /* by which a stretch turns */
    union simd_lanes gain_mps2; /* and gains speed along its heading */
    union lane_masks refused;   /* result: the row was not moved (ground_vehicle_move()) */
};

/* Returns the time by which the rows move. */
static inline double ground_vehicle_time_s(const struct step_context *context,
                                           const struct ground_vehicle *batch)
{
    return context->dt_s * (double)batch->frames;
}

/* Returns the desired motion of the row in lane l, which has been moved or refused. */
struct desired_motion ground_vehicle_desired(const struct ground_vehicle *batch, int l);

/* Empties a batch of rows that move by so many frames. */
void ground_vehicle_begin(struct ground_vehicle *batch, uint32_t frames);

/* Gives row i a lane. True when the batch is full. */
bool ground_vehicle_take(const struct step_context *context, struct ground_vehicle *batch,
                         uint32_t i, const struct desired_motion *desired);

/* The same with the motion of agent_controls_motion(), computed here for eight rows at once. */
bool ground_vehicle_take_held(const struct step_context *context, struct ground_vehicle *batch,
                              uint32_t i);

/* Moves the rows of the batch. Their lanes stay taken, so that the caller can read blocked.
 *
 * A batch of stretches moves a row only where the motion of one long frame is that of many short
 * ones within some centimetres: on ground without craters, works and debris, not through water, at
 * a speed and in a direction that change little. It leaves other rows as they were (refused). A
 * batch of one frame leaves rows as they were that come from their springs and cannot follow the
 * ground yet. */
void ground_vehicle_move(const struct step_context *context, struct ground_vehicle *batch);

/* A vehicle that comes back from its springs takes the height of the ground at this rate, and then
 * loses its flag. */
#define GROUND_VEHICLE_EASE_MPS 0.04

/* Writes height, pitch and roll of row i, which has ENTITY_FLAG_CHASSIS and is calm. It goes with
 * the ground, and what it differs by from a row that follows the ground eases to nothing, bit by
 * bit. before, now: how such a row stands at its old and at its new place. Takes the flag away when
 * they agree. */
void ground_vehicle_ease(const struct step_context *context, uint32_t i,
                         const struct rest_pose *before, const struct rest_pose *now);

/* Returns the share of full speed that debris leaves row i where it is. */
double ground_vehicle_debris(const struct step_context *context, uint32_t i);

#endif
