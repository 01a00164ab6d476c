/* Places the trees and bushes of Table 1, most of them in the squares that suit them best. */
#ifndef JOLON_WORLD_MAKING_PLANT_PLACEMENT_H
#define JOLON_WORLD_MAKING_PLANT_PLACEMENT_H

#include "world/making/object_placement.h"

/* Number of occupied squares of the world, those with other objects included; it gives Table 1's
 * average of 3.9 (Osborne 1991, p. 8; over all squares the average would be 0.25). */
#define PLANT_PLACEMENT_SQUARES 10334u

/* Table 1's maximum: no square holds more, and one holds exactly this. */
#define PLANT_PLACEMENT_SQUARE_MAX 18u

/* Adds Table 1's trees and bushes clear of the objects so far, in squares without any. Returns 0;
 * -1 with errno ENOMEM, or ENOSPC if there is too little dry land. */
int plant_placement_plant(struct object_placement *placement);

#endif
