/* Motion of wrecks: they fall, tumble and slide as rigid bodies whose points touch the ground,
 * until they come to rest. Nearly all of them lie still.
 *
 * The column until_tick of a wreck says whether it rests. 0: it moves. Otherwise it is the tick at
 * which a wreck that moves slowly comes to rest. From then on a wreck without velocity and spin
 * stays as it is, in the pose in which it came to rest. The collider sets until_tick to 0 when
 * something is destroyed, when it displaces a wreck and when a crater is dug under one. */
#ifndef JOLON_MOVER_MOTION_WRECK_H
#define JOLON_MOVER_MOTION_WRECK_H

#include "mover/context/step_context.h"

/* Moves row i, a wreck; a wreck at rest stays as it is. */
void wreck_row(const struct step_context *context, uint32_t i);

#endif
