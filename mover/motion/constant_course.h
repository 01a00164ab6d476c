/* Motion without a will. A row goes by itself; those that then stand on the ground take a lane, and
 * are set upon it together. */
#ifndef JOLON_MOVER_MOTION_CONSTANT_COURSE_H
#define JOLON_MOVER_MOTION_CONSTANT_COURSE_H

#include "mover/motion/ground_pose.h"

/* Row i keeps heading and speed and reacts to nothing, save that what ran into it may have set it
 * turning; a land vehicle's height is the ground's, a ship's the water's. True when it is to take a
 * lane. */
bool constant_course_row(const struct step_context *context, uint32_t i);

struct constant_course {
    int count; /* lanes taken */
    uint32_t row[LANE_COUNT];
    union simd_lanes heading;
    struct ground_pose pose;
};

/* Without anybody. */
void constant_course_begin(struct constant_course *batch);

/* Row i takes a lane: true when that was the last. */
bool constant_course_take(const struct step_context *context, struct constant_course *batch,
                          uint32_t i);

/* Sets those who have a lane on the ground; their lanes stay taken. */
void constant_course_set_down(const struct step_context *context, struct constant_course *batch);

#endif
