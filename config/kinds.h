/* Kinds: config/kinds/NAME.cfg, one file a kind, and the models they name. */
#ifndef JOLON_CONFIG_KINDS_H
#define JOLON_CONFIG_KINDS_H

#include "config/loader.h"

#include <xxhash.h>

/* Reads every kind in name order into the scenario, their files into the hash. 0; -1 with the
 * message: a bad key, a name other than the file's, values that do not go together, a model or
 * munition that does not exist. */
int kinds_read(struct scenario *scenario, const char *data_dir, XXH3_state_t *hash,
               struct loader_message *message);

#endif
