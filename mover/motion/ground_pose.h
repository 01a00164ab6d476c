/* Height, pitch and roll of eight bodies on the ground: the height under the middle, and the slopes
 * between the heights under front and back and under the sides. */
#ifndef JOLON_MOVER_MOTION_GROUND_POSE_H
#define JOLON_MOVER_MOTION_GROUND_POSE_H

#include "mover/context/step_context.h"
#include "world/terrain/terrain_cache.h"

/* While a row takes a lane, the terrain entry of the row this many rows ahead is prefetched. The
 * table of entries is longer than that of rows by this number. */
#define GROUND_POSE_AHEAD 16u

struct ground_pose {
    struct terrain_cache ground;
    struct terrain_cache_entry idle;          /* of free lanes */
    union simd_lanes x, z, sine, cosine;      /* the last two: of the heading */
    union simd_lanes half_length, half_width; /* of the kind [m] */
    uint16_t kind[LANE_COUNT];                /* of the half sizes; KIND_NONE: none yet */
    union lane_masks cratered;                /* there may be craters under the body */
    union simd_lanes y, pitch, roll;          /* results */
    union simd_lanes step; /* result: by which craters differ, and works bend, under it [m] */
    union simd_lanes lift; /* result: by which y is above the ground under the middle [m] */
};

/* Empties all lanes. */
void ground_pose_begin(struct ground_pose *pose);

/* Gives lane l to row i. The caller sets sine, cosine and cratered. True when the row before in
 * this lane was of another kind: values of the kind stay in the lane from row to row. */
bool ground_pose_take(const struct step_context *context, struct ground_pose *pose, int l,
                      uint32_t i);

/* Computes y, pitch and roll of all lanes. */
void ground_pose_find(const struct step_context *context, struct ground_pose *pose);

#endif
