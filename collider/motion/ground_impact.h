/* When a row's body meets the ground. */
#ifndef JOLON_COLLIDER_MOTION_GROUND_IMPACT_H
#define JOLON_COLLIDER_MOTION_GROUND_IMPACT_H

#include "collider/motion/body_motion.h"
#include "collider/motion/pair_filter.h"

/* Returns by how much the path of a body of a kind has to be lowered so that it reaches the ground
 * if any of its points may, on slopes up to 60 degrees [m]. Any thread. */
double ground_impact_lower(const struct world *world, uint16_t kind);

/* Returns true if the row meets the ground within the rest of the frame; *toi is then when. A
 * munition meets it with its position. Another body meets it with a vertex of its outer hull, or
 * with a corner of its box where bodies collide as spheres; the path of such a point is taken as
 * straight. A body that is partly under the ground meets it at once. Any thread. */
bool ground_impact_row(const struct method_input *input, const struct body_motion *motion,
                       uint32_t row, double *toi);

#endif
