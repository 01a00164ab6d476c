/* Reading a scenario and making what it says: shared by the verbs that create, check and replay. */
#ifndef JOLON_RECORDER_REPLAY_SCENARIO_LOAD_H
#define JOLON_RECORDER_REPLAY_SCENARIO_LOAD_H

#include "recorder/replay/arguments.h"

struct provenance;
struct scenario;

/* Reads the scenario path with the overrides set and the length seconds of the arguments; the
 * caller's to free. Ends the process with the reason (exit 1). */
void scenario_load_scenario(const struct arguments *arguments, struct scenario *scenario);

/* Makes its world in plain memory; the caller's to free. Ends the process likewise. */
void scenario_load_generate(const struct scenario *scenario, struct world_build *built);

/* Adds --seconds, where given, to a recipe. */
void scenario_load_provenance_seconds(const struct arguments *arguments, struct provenance *recipe);

#endif
