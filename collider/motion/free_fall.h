/* Wrecks that fall freely through the frame. The mover has given them the speed of the whole fall;
 * an answer within the frame must not count what comes after it. One thread. */
#ifndef JOLON_COLLIDER_MOTION_FREE_FALL_H
#define JOLON_COLLIDER_MOTION_FREE_FALL_H

#include "collider/motion/body_motion.h"

/* Returns true if the mover has changed the velocity of a row by its weight and nothing else. */
bool free_fall_only(const struct body_motion *motion, uint32_t row);

/* Returns the downward speed that its weight gives the row between the time and the frame's end
 * [m/s]; 0 if it does not fall freely. The first call for a row in a frame must be before its next
 * row changes. */
double free_fall_left_mps(const struct body_motion *motion, uint32_t row, double time);

/* From now on the row does not fall freely in this frame. */
void free_fall_end(const struct body_motion *motion, uint32_t row);

#endif
