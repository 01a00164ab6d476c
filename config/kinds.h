/* Reader of the kinds, config/kinds/NAME.cfg, one file each, and of the models that they name. */
#ifndef JOLON_CONFIG_KINDS_H
#define JOLON_CONFIG_KINDS_H

#include "world/runtime/error_text.h"

#include <xxhash.h>

struct hulls;
struct kind;
struct scenario;

/* Reads every kind into the scenario, in order of their names, and adds their files to the hash. 0;
 * -1 with the message: a wrong key, a name that is not the file's, values that do not fit each
 * other, an unknown model or munition. */
int kinds_read(struct scenario *scenario, const char *data_dir, XXH3_state_t *hash,
               struct error_text *error);

/* Returns the stiffness of a kind whose file gives none: its skin takes up its resistance over a
 * quarter of its smallest side [N/m]. */
double kinds_stiffness(const struct kind *kind);

/* Sets the members of a kind that follow from its hulls. */
void kinds_take_hulls(struct kind *kind, const struct scenario *scenario,
                      const struct hulls *hulls);

#endif
