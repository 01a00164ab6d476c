/* Scripts: a scenario's list of them, their steps, and files of waypoints. */
#ifndef JOLON_CONFIG_SCRIPTS_H
#define JOLON_CONFIG_SCRIPTS_H

#include "config/keys.h"

#include <xxhash.h>

/* Takes the setting "scripts" (NULL: none) of a file; waypoint files lie in its folder, and their
 * text goes into hash. 0, or -1 with the message. */
int scripts_read(struct scenario *scenario, const config_setting_t *list, const char *file,
                 XXH3_state_t *hash, struct loader_message *message);

/* Index of the script called name, UINT32_MAX when there is none. */
uint32_t scripts_find(const struct scenario *scenario, const char *name);

#endif
