/* Reader of a scenario's list of vehicles. */
#ifndef JOLON_CONFIG_VEHICLES_H
#define JOLON_CONFIG_VEHICLES_H

#include "config/syntax/key_table.h"

struct scenario;

/* Reads the setting "vehicles" of a file; NULL is an empty list. The scenario's kinds, scripts and
 * params.capacity must be read before. 0; -1 with the message. */
int vehicles_read(struct scenario *scenario, const config_setting_t *list, const char *file,
                  struct error_text *error);

#endif
