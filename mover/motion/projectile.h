/* Motion of munitions: ballistic, or homing on their target. */
#ifndef JOLON_MOVER_MOTION_PROJECTILE_H
#define JOLON_MOVER_MOTION_PROJECTILE_H

#include "mover/context/step_context.h"

struct kind;
struct params;

void projectile_move(const struct step_context *context, uint32_t i);

/* Moves a ballistic round of the kind by dt_s under drag, wind and gravity. Pure; any thread. */
void projectile_fall(const struct kind *kind, struct vec3 wind, double dt_s, struct vec3 *at,
                     struct vec3 *velocity);

/* Returns the velocity of the air [m/s, world]. Pure; any thread. */
struct vec3 projectile_wind(const struct params *params);

#endif
