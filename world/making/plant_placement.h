/* Groves: the trees and bushes of Table 1, thick in the squares that suit them best. */
#ifndef JOLON_WORLD_MAKING_PLANT_PLACEMENT_H
#define JOLON_WORLD_MAKING_PLANT_PLACEMENT_H

#include "world/making/object_placement.h"

/* Every occupied square of the world, those of the objects before included: what makes Table 1's
 * average of 3.9 (Osborne 1991, p. 8; over all squares it would be 0.25). */
#define PLANT_PLACEMENT_SQUARES 10334u

/* Table 1's maximum: no square holds more, one holds as many. */
#define PLANT_PLACEMENT_SQUARE_MAX 18u

/* Adds Table 1's trees and bushes clear of what stands already, in squares where nothing does. 0;
 * -1 with errno ENOMEM, or ENOSPC when there is too little dry land. */
int plant_placement_plant(struct object_placement *placement);

#endif
