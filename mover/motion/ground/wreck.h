/* Motion of wrecks: they fall, tumble and slide as rigid bodies whose points touch the ground,
 * until they come to rest. Nearly all of them lie still.
 *
 * The field until_tick of a wreck says whether it rests. 0: it moves. Otherwise it is the tick at
 * which a wreck that moves slowly comes to rest. From then on a wreck without velocity and spin
 * stays as it is, in the pose in which it came to rest. The collider sets until_tick to 0 when
 * something is destroyed, when it displaces a wreck and when a crater is dug under one.
 *
 * The ground breaks up an aircraft's wreck that strikes it too hard: ENTITY_FLAG_BROKEN of the
 * field flags. The row then stands for all pieces together, with the mass of all: breaking
 * changes no velocity, so momentum is conserved. What the pieces need to scatter is less than the
 * energy that the ground has taken in the impact. */
#ifndef JOLON_MOVER_MOTION_WRECK_H
#define JOLON_MOVER_MOTION_WRECK_H

#include "mover/context/serial_context.h"
#include "mover/context/step_context.h"

/* An airframe breaks up where the ground takes more energy along its normal in an impact than this
 * [J/kg]: half the square of 15.2 m/s (50 ft/s), the hardest impact in which MIL-STD-1290A asks an
 * airframe to keep room for its crew. */
#define WRECK_BREAKS_JPKG 115.5

/* Moves row i, a wreck; a wreck at rest stays as it is. */
void wreck_row(const struct step_context *context, uint32_t i);

/* Returns true if row i is a wreck at rest: it stays as it is until something changes it. */
bool wreck_rests(const struct step_context *context, uint32_t i);

/* Tells in an event that row i has broken up in this frame. Serial. */
void wreck_tell_broken(struct serial_context *context, uint32_t i);

#endif
