/* Muster: a scenario's vehicles take their places for frame 0, alone or in formation. */
#ifndef JOLON_WORLD_MUSTER_H
#define JOLON_WORLD_MUSTER_H

#include "world/complaint.h"
#include "world/genesis.h"

/* Fills the genesis's first entities, names, formations and bases; its ground and objects must be
 * there. 0, or -1 with the complaint: no room in the table, no place on the map, out of memory. */
int muster_build(struct genesis *genesis, const struct complaint *to);

#endif
