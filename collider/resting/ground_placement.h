/* Sets bodies on the ground. */
#ifndef JOLON_COLLIDER_RESTING_GROUND_PLACEMENT_H
#define JOLON_COLLIDER_RESTING_GROUND_PLACEMENT_H

#include "collider/response/response_context.h"

/* Puts a row that the ground holds to this place on the map (at.y is ignored), with this heading. A
 * vehicle that drives takes its height, pitch and roll from the ground there. A wreck, and a
 * vehicle on its springs, keep their pose and their height over the ground. */
void ground_placement_put(struct response_context *context, uint32_t row, struct vec3 at,
                          double heading_rad);

#endif
