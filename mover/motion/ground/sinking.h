/* Wrecks on water: hulls settle until their upper works stand out of it, aircraft and vehicles go
 * under. The water's bed is not part of the terrain. */
#ifndef JOLON_MOVER_MOTION_GROUND_SINKING_H
#define JOLON_MOVER_MOTION_GROUND_SINKING_H

#include "mover/context/step_context.h"

/* Lowers row i, a ship's wreck, for a frame. Returns true if it still sinks. */
bool sinking_hull(const struct step_context *context, uint32_t i);

/* Row i, another wreck, has become slow. Returns true if it floats on water: then it begins to
 * sink. */
bool sinking_begin(const struct step_context *context, uint32_t i);

/* Lowers row i if it sinks, and stops it where it is under the water. Returns false if it does not
 * sink and is not under water. */
bool sinking_row(const struct step_context *context, uint32_t i);

#endif
