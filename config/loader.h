/* Reads the configuration into a struct scenario: the files of a scenario, of kinds and of models.
 * Start-up only: nothing here is called while a world runs. */
#ifndef JOLON_CONFIG_LOADER_H
#define JOLON_CONFIG_LOADER_H

#include "world/runtime/error_text.h"

struct params;
struct scenario;

/* Sets the default of every key, then reads the scenario file, then the overrides "group.key=value"
 * in order, then every data_dir/kinds/ *.cfg in order of their names with the models they name,
 * then the scenario's lists. So a wrong key of the user is refused before the other files are read.
 * path: NULL for data_dir/scenarios/hunter-liggett.cfg; a name without '/' that is no file in the
 * working directory is looked up in data_dir/scenarios/. 0; -1 with the message, and scenario
 * empty. */
int loader_scenario(struct scenario *scenario, const char *data_dir, const char *path,
                    const char *const *overrides, int override_count, struct error_text *error);

/* Applies overrides to the parameters of a world that exists. Refuses keys from which a count, a
 * capacity or an object of the world follows. Each override that changes a value changes
 * scenario_hash. 0; -1 with the message, and params as they were. */
int loader_branch(struct params *params, const char *const *overrides, int override_count,
                  struct error_text *error);

#endif
