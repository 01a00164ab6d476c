/* Lists: the scenario's vehicles, fixed objects and ordered shots, entry by entry, with the names
 * of kinds and vehicles resolved. */
#ifndef JOLON_CONFIG_LISTS_H
#define JOLON_CONFIG_LISTS_H

#include "config/keys.h"

/* Each takes the setting of that name (NULL: an empty list) of a file. The scenario's kinds,
 * scripts and params.capacity must be final. 0, or -1 with the message. */
int lists_vehicles(struct scenario *scenario, const config_setting_t *list, const char *file,
                   struct loader_message *message);
int lists_objects(struct scenario *scenario, const config_setting_t *list, const char *file,
                  struct loader_message *message);

int lists_bases(struct scenario *scenario, const config_setting_t *list, const char *file,
                struct loader_message *message);

/* After lists_vehicles() with the same vehicles: shooters and targets are their names, which are
 * checked here to be different. */
int lists_fires(struct scenario *scenario, const config_setting_t *list,
                const config_setting_t *vehicles, const char *file, struct loader_message *message);

#endif
