/* Reader of the kinds, config/kinds/NAME.cfg, one file each, and of the models that they name. */
#ifndef JOLON_CONFIG_KINDS_H
#define JOLON_CONFIG_KINDS_H

#include "world/runtime/error_text.h"

#include <xxhash.h>

struct scenario;

/* Reads every kind into the scenario, in order of their names, and adds their files to the hash. 0;
 * -1 with the message: a wrong key, a name that is not the file's, values that do not fit each
 * other, an unknown model or munition. */
int kinds_read(struct scenario *scenario, const char *data_dir, XXH3_state_t *hash,
               struct error_text *error);

#endif
