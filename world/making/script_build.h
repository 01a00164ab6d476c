/* Scripting: the scenario's scripts become those of its vehicles. */
#ifndef JOLON_WORLD_MAKING_SCRIPT_BUILD_H
#define JOLON_WORLD_MAKING_SCRIPT_BUILD_H

#include "world/runtime/error_text.h"
#include "world/name_index.h"

#include <stdbool.h>

struct scenario;
struct world_build;

/* The first point that a script goes to, and the next; false when it goes nowhere. With one point
 * only the next is the same. */
bool script_build_start(const struct scenario *scenario, uint32_t script, double first[2],
                        double next[2]);

/* Fills the built world's scripts and steps, and gives the vehicles their own; they must have their
 * places. 0, or -1 with the complaint: an unknown name, ground or a speed that the kind cannot do,
 * too many steps, out of memory. */
int script_build_build(struct world_build *built, const struct name_index *name_index,
                       struct error_text *error);

#endif
