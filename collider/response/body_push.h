/* An impulse at a point of one body: how easily the point gives way, and the body's new path. */
#ifndef JOLON_COLLIDER_RESPONSE_BODY_PUSH_H
#define JOLON_COLLIDER_RESPONSE_BODY_PUSH_H

#include "collider/response/response_context.h"

/* Returns the change of speed [1/kg] along the direction, at the point, by a unit impulse there.
 * direction: unit, world axes; horizontal for a body that the ground holds. */
double body_push_mobility(const struct response_context *context, uint32_t row, double time,
                          struct vec3 point, struct vec3 direction);

/* Gives the row the impulse [N s] at the point, and the path that follows from it. A body that the
 * ground holds takes the horizontal part and the spin about the vertical only (docs/decisions/008);
 * its climb changes with its speed, so that it keeps to its slope. Call path_change_swept
 * afterwards. */
void body_push(struct response_context *context, uint32_t row, double time, struct vec3 point,
               struct vec3 impulse_ns);

/* Returns the row's centre of mass at this time [m, world], and its rotation. */
struct vec3 body_push_centre(const struct response_context *context, uint32_t row, double time,
                             struct mat3 *turn);

#endif
