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

/* Tells that from now on the row moves at the speed that its fall gives it until the frame's end.
 */
void free_fall_ahead(const struct body_motion *motion, uint32_t row);

/* Returns how much of that speed a row has that it gets only after this time [m/s, >= 0]: if it
 * stays where it is from then on, its weight has not done that work. */
double free_fall_unearned_mps(const struct body_motion *motion, uint32_t row, double time);

#endif
