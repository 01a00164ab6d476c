/* Bodies on the ground, a lane each: the height under the middle, and pitch and roll by the heights
 * under nose, tail and sides. */
#ifndef JOLON_MOVER_MOTION_GROUND_POSE_H
#define JOLON_MOVER_MOTION_GROUND_POSE_H

#include "mover/context/step_context.h"
#include "world/terrain/terrain_cache.h"

/* Whose patch is asked for while a row takes its lane; there are so many more patches than rows. */
#define GROUND_POSE_AHEAD 16u

struct ground_pose {
    struct terrain_cache ground;
    struct terrain_cache_entry idle;          /* of lanes that are nobody's yet */
    union simd_lanes x, z, sine, cosine;      /* of the heading */
    union simd_lanes half_length, half_width; /* of the kind [m] */
    uint16_t kind[LANE_COUNT];                /* whose they are; KIND_NONE: nobody's yet */
    union lane_masks cratered;                /* there may be craters under it */
    union simd_lanes y, pitch, roll;          /* what comes out */
};

/* No lane is anybody's yet. */
void ground_pose_begin(struct ground_pose *pose);

/* Lane l is row i's, where the row is now; its heading is the caller's to say, and its scars. True
 * when the lane was another kind's: what it holds of the kind stays from one row to the next. */
bool ground_pose_take(const struct step_context *context, struct ground_pose *pose, int l,
                      uint32_t i);

void ground_pose_move(const struct step_context *context, struct ground_pose *pose);

#endif
