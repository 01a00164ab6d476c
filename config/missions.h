/* Reader of a scenario's lists of objectives and missions, with their phases and reactions. */
#ifndef JOLON_CONFIG_MISSIONS_H
#define JOLON_CONFIG_MISSIONS_H

#include "config/syntax/key_table.h"

struct scenario;

/* Reads the settings "objectives" and "missions" below the root of a file. The scenario's kinds and
 * vehicles must be read before. 0; -1 with the message. */
int missions_read(struct scenario *scenario, const config_setting_t *root, const char *file,
                  struct error_text *error);

/* Index of the objective called name; MISSION_NONE: there is none. */
uint32_t missions_objective(const struct scenario *scenario, const char *name);

#endif
