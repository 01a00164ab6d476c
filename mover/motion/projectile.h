/* Motion of munitions: ballistic, or homing on their target. */
#ifndef JOLON_MOVER_MOTION_PROJECTILE_H
#define JOLON_MOVER_MOTION_PROJECTILE_H

#include "mover/context/step_context.h"

void projectile_move(const struct step_context *context, uint32_t i);

#endif
