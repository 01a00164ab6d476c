/* Builds the missions of a world from those of the scenario. */
#ifndef JOLON_WORLD_MAKING_MISSION_BUILD_H
#define JOLON_WORLD_MAKING_MISSION_BUILD_H

#include "world/runtime/error_text.h"

struct world_build;

/* Fills the built world's missions, their phases and the slots of their vehicles, which must have
 * been placed. Returns 0, or -1 with error set: out of memory. */
int mission_build_build(struct world_build *built, struct error_text *error);

#endif
