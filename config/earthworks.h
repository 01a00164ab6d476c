/* Reader of a scenario's list of earthworks. */
#ifndef JOLON_CONFIG_EARTHWORKS_H
#define JOLON_CONFIG_EARTHWORKS_H

#include "config/syntax/key_table.h"

struct scenario;

/* Reads the setting "earthworks" of a file; NULL is an empty list. Computes the slopes of each work
 * from its keys. Refuses keys that its shape does not have, slopes that do not fit into it, and a
 * work that reaches out of the world. 0; -1 with the message. */
int earthworks_read(struct scenario *scenario, const config_setting_t *list, const char *file,
                    struct error_text *error);

#endif
