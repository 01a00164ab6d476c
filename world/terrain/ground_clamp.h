/* Places of vehicles that somebody else has on another model of the ground. */
#ifndef JOLON_WORLD_TERRAIN_GROUND_CLAMP_H
#define JOLON_WORLD_TERRAIN_GROUND_CLAMP_H

#include "world/terrain/terrain.h"

/* Sets a place on the ground, craters included, if it is within so many metres above or below it.
 * Returns true if it was. craters may be NULL. Pure; any thread. */
bool ground_clamp(const struct terrain *terrain, const struct crater_index *craters,
                  double within_m, struct vec3 *at);

#endif
