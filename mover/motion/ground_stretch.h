/* Which land vehicles on easy ground can be moved by a stretch (world/entity/cruise.h). */
#ifndef JOLON_MOVER_MOTION_GROUND_STRETCH_H
#define JOLON_MOVER_MOTION_GROUND_STRETCH_H

#include "mover/motion/ground_vehicle.h"

/* Marks the lanes of a batch, which have moved by a stretch, whose rows cannot be moved so. It
 * reads what ground_vehicle_move() has found out, and the rows as they were. rightward: the speed
 * at which a vehicle slides to its right [m/s]. */
void ground_stretch_refuse(const struct step_context *context, struct ground_vehicle *batch,
                           const union simd_lanes *rightward);

#endif
