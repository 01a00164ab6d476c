/* The shots that the scenario orders: its list `fires`. */
#ifndef JOLON_MOVER_WEAPON_SCENARIO_FIRES_H
#define JOLON_MOVER_WEAPON_SCENARIO_FIRES_H

#include "mover/context/serial_context.h"

/* Carries out the orders whose time has come. An order of a vehicle that is lost, or at one, is
 * left out. */
void scenario_fires_run(struct serial_context *context);

#endif
