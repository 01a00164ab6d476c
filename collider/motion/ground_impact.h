/* When a row's body meets the ground. */
#ifndef JOLON_COLLIDER_MOTION_GROUND_IMPACT_H
#define JOLON_COLLIDER_MOTION_GROUND_IMPACT_H

#include "collider/motion/body_motion.h"
#include "collider/motion/pair_filter.h"

/* Returns by how much a path has to be lowered so that it reaches the ground if any point within
 * reach_m of it may, on slopes up to 60 degrees [m]. */
static inline double ground_impact_lower(double reach_m)
{
    return 2.0 * reach_m;
}

/* Returns true if the row meets the ground within the rest of the frame; *toi is then when. A
 * munition, and everything where bodies collide as spheres, meets it with its position. Another
 * body meets it with a vertex of its outer hull, whose path is taken as straight. A body that is
 * partly under the ground meets it at once. Any thread. */
bool ground_impact_row(const struct method_input *input, const struct body_motion *motion,
                       uint32_t row, double *toi);

#endif
