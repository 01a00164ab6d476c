/* Readers of a scenario's lists of fixed objects, bases and ordered shots. They look up the names
 * of kinds and vehicles. */
#ifndef JOLON_CONFIG_SYNTAX_LISTS_H
#define JOLON_CONFIG_SYNTAX_LISTS_H

#include "config/syntax/key_table.h"

struct scenario;

/* Each reads the setting of its name of a file; NULL is an empty list. The scenario's kinds
 * must be read before. 0; -1 with the message. */
int lists_objects(struct scenario *scenario, const config_setting_t *list, const char *file,
                  struct error_text *error);

int lists_bases(struct scenario *scenario, const config_setting_t *list, const char *file,
                struct error_text *error);

/* Call after vehicles_read() with the same vehicles. Shooters and targets are names of vehicles;
 * two vehicles with the same name are refused here. */
int lists_fires(struct scenario *scenario, const config_setting_t *list,
                const config_setting_t *vehicles, const char *file, struct error_text *error);

#endif
