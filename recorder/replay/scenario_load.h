/* Reads a scenario and makes its world, for the verbs that create, check and replay. */
#ifndef JOLON_RECORDER_REPLAY_SCENARIO_LOAD_H
#define JOLON_RECORDER_REPLAY_SCENARIO_LOAD_H

#include "recorder/replay/arguments.h"

struct provenance;
struct scenario;

/* Reads the scenario that the arguments name, with --set and --seconds. The caller frees it. Ends
 * the process with the reason (exit 1). */
void scenario_load(const struct arguments *arguments, struct scenario *scenario);

/* Makes the scenario's world in private memory. The caller frees it. Ends the process with the
 * reason (exit 1). */
void scenario_load_generate(const struct scenario *scenario, struct world_build *built);

/* Adds --seconds to the provenance, if the option is given. */
void scenario_load_note_seconds(const struct arguments *arguments, struct provenance *recipe);

#endif
