/* What the parts of avoidance share. Pure; any thread. */
#ifndef JOLON_MOVER_AGENT_AVOIDANCE_INTERNAL_H
#define JOLON_MOVER_AGENT_AVOIDANCE_INTERNAL_H

#include "mover/agent/avoidance.h"
#include "world/entity/kind.h"

/* Returns the gap to obstacles that a kind keeps [m]. */
double avoidance_gap(const struct kind *kind);

/* Returns how far a vehicle looks ahead at a speed [m]. */
double avoidance_horizon(const struct kind *kind, double speed_mps);

/* Returns how far it looks for other vehicles, which may come towards it [m]. */
double avoidance_around(double horizon_m);

#endif
