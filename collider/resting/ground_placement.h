/* Sets bodies on the ground, and finds those that others have pushed into it. */
#ifndef JOLON_COLLIDER_RESTING_GROUND_PLACEMENT_H
#define JOLON_COLLIDER_RESTING_GROUND_PLACEMENT_H

#include "collider/geometry/level_exit.h"
#include "collider/response/response_context.h"

/* Puts a row that the ground holds to this place on the map (at.y is ignored), with this heading. A
 * vehicle that drives takes its height, pitch and roll from the ground there. A wreck, and a
 * vehicle on its springs, keep their pose and their height over the ground. */
void ground_placement_put(struct response_context *context, uint32_t row, struct vec3 at,
                          double heading_rad);

/* Puts vehicles that hold their course on the craters of this frame, which are those from first on
 * and in the index of the context: the ground lifts them by geometry. All others are pushed by
 * what digs a crater and take to their springs. */
void ground_placement_dug(struct response_context *context, uint32_t first);

/* Puts the vehicles whose path a response has changed on the ground where they end the frame: a
 * response without a guard at the frame's end leaves them on the straight way to where they would
 * have been. */
void ground_placement_changed(struct response_context *context);

/* Returns the slope of the ground under a pair when the frame begins: the mean of both sides, that
 * of the first where the second is a fixed object, none on water. */
struct exit_slope ground_placement_slope(const struct response_context *context, uint32_t a,
                                         uint32_t b);

/* Returns true for a wreck, or a vehicle on its springs, that ends the frame deeper in the ground
 * than it began it: other bodies have driven it there. Less than what solvers leave does not
 * count. moved: contacts have moved the row in this frame; an impact is known to have done so. */
bool ground_placement_sinks(const struct response_context *context, uint32_t row, bool moved);

#endif
