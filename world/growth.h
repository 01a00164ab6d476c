/* What grows where: how well trees and bushes do on the land. */
#ifndef JOLON_WORLD_GROWTH_H
#define JOLON_WORLD_GROWTH_H

#include "world/land.h"

/* Fills forest and chaparral from the heights, streams and the distance from the sea. 0, or -1 with
 * errno ENOMEM. */
int growth_fill(struct land *land, uint64_t seed);

#endif
