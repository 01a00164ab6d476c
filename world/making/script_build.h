/* Builds the scripts of vehicles from those of the scenario. */
#ifndef JOLON_WORLD_MAKING_SCRIPT_BUILD_H
#define JOLON_WORLD_MAKING_SCRIPT_BUILD_H

#include "world/runtime/error_text.h"
#include "world/name_index.h"

#include <stdbool.h>

struct scenario;
struct world_build;

/* Returns the first point of a script, and the next one. Returns false if it has no point. With one
 * point only, the next is the same. */
bool script_build_start(const struct scenario *scenario, uint32_t script, double first[2],
                        double next[2]);

/* Fills the built world's scripts and steps, and gives the vehicles their own; they must have been
 * placed. Returns 0, or -1 with error set: an unknown name, ground or a speed that is impossible
 * for the kind, too many steps, out of memory. */
int script_build_build(struct world_build *built, const struct name_index *name_index,
                       struct error_text *error);

#endif
