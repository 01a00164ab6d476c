/* Reading a scenario and making what it says: shared by the verbs that create, check and replay. */
#ifndef JOLON_WORLDCTL_LOAD_H
#define JOLON_WORLDCTL_LOAD_H

#include "world/genesis.h"
#include "worldctl/arguments.h"

/* Reads the scenario path with the overrides set and the length seconds of the arguments; the
 * caller's to free. Ends the process with the reason (exit 1). */
void load_scenario(const struct arguments *arguments, struct scenario *scenario);

/* Makes its world in plain memory; the caller's to free. Ends the process likewise. */
void load_generate(const struct scenario *scenario, struct genesis *genesis);

/* Adds --seconds, where given, to a recipe. */
void load_recipe_seconds(const struct arguments *arguments, struct recipe *recipe);

#endif
