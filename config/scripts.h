/* Reader of a scenario's list of scripts, with their steps and files of waypoints. */
#ifndef JOLON_CONFIG_SCRIPTS_H
#define JOLON_CONFIG_SCRIPTS_H

#include "config/syntax/key_table.h"

#include <xxhash.h>

struct scenario;

/* Reads the setting "scripts" of a file; NULL is an empty list. Files of waypoints are in the
 * file's folder, and their text is added to the hash. 0; -1 with the message. */
int scripts_read(struct scenario *scenario, const config_setting_t *list, const char *file,
                 XXH3_state_t *hash, struct error_text *error);

/* Index of the script called name; UINT32_MAX: there is none. */
uint32_t scripts_find(const struct scenario *scenario, const char *name);

#endif
