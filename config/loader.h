/* The one reader of configuration: kinds, models and scenario files (libconfig) into a struct
 * scenario. Start-up only; nothing of it is called while a world runs. */
#ifndef JOLON_CONFIG_LOADER_H
#define JOLON_CONFIG_LOADER_H

#include "world/scenario.h"

struct loader_message {
    char text[1024]; /* "file:line: key = value: what is wrong; what would be right" */
};

/* Reads the scenario file (NULL: data_dir/scenarios/hunter-liggett.cfg; a plain name without '/'
 * that is no file here is looked up in data_dir/scenarios/), then the overrides "dotted.key=value"
 * in order, then every data_dir/kinds/ *.cfg (in name order) and the models they name: a wrong key
 * of the user's is refused before the rest is read. Sets every key's default first. 0; -1 with the
 * message, and scenario empty. */
int loader_scenario(struct scenario *scenario, const char *data_dir, const char *path,
                    const char *const *overrides, int override_count,
                    struct loader_message *message);

/* Applies overrides to the parameters of a world that was made already: keys that no count, no
 * capacity and nothing that stands in the world follows from. Each that changes something changes
 * scenario_hash. 0; -1 with the message, and params as they were. */
int loader_branch(struct params *params, const char *const *overrides, int override_count,
                  struct loader_message *message);

#endif
