/* Places a scenario's vehicles for frame 0, alone or in formation. */
#ifndef JOLON_WORLD_MAKING_VEHICLE_PLACEMENT_H
#define JOLON_WORLD_MAKING_VEHICLE_PLACEMENT_H

#include "world/runtime/error_text.h"

struct world_build;

/* Fills the built world's first entities, names, formations and bases; its ground and objects must
 * be there. Returns 0, or -1 with error set: no room in the table, no place on the map, out of
 * memory. */
int vehicle_placement_build(struct world_build *built, struct error_text *error);

#endif
