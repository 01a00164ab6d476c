/* Motion of vehicles with BEHAVIOUR_HOLD. Those on the ground are then set down on it in batches of
 * eight. */
#ifndef JOLON_MOVER_MOTION_CONSTANT_COURSE_H
#define JOLON_MOVER_MOTION_CONSTANT_COURSE_H

#include "mover/motion/ground_pose.h"

enum course_result {
    COURSE_DONE,
    COURSE_GROUND,    /* a land vehicle, which then takes a lane */
    COURSE_AGROUND,   /* a ship: flags, trigger and harm_j may have changed */
    COURSE_LEFT_WORLD /* it has crossed the edge of the world */
};

/* Moves row i by its heading and speed. */
enum course_result constant_course_row(const struct step_context *context, uint32_t i);

struct constant_course {
    int count; /* lanes taken */
    uint32_t row[LANE_COUNT];
    union simd_lanes heading;
    struct ground_pose pose;
};

/* Empties the batch. */
void constant_course_begin(struct constant_course *batch);

/* Gives row i a lane. True when the batch is full. */
bool constant_course_take(const struct step_context *context, struct constant_course *batch,
                          uint32_t i);

/* Sets the rows of the batch down on the ground; their lanes stay taken. */
void constant_course_set_down(const struct step_context *context, struct constant_course *batch);

#endif
