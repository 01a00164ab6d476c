/* The ground file of a scenario: where it is, and what its header says. */
#ifndef JOLON_CONFIG_GROUND_SOURCE_H
#define JOLON_CONFIG_GROUND_SOURCE_H

#include "config/syntax/key_table.h"

struct scenario_settings;

#define GROUND_SOURCE_KEY "terrain.file"

/* With terrain.source = "file": finds the file that settings->ground_file names, sets its absolute
 * path and the hash of its ground, and middle: latitude, longitude [deg] and undulation [m] of the
 * middle of its square. Looks in the folder of the scenario, then in the current one, then in
 * data_dir/grounds; of an override first in the current one. place: of the key, for messages.
 * Sets settings->side_m if it is 0. Refuses a file that is missing or damaged, and one that does
 * not fit into the world. 0; -1 with the
 * message. */
int ground_source_read(struct scenario_settings *settings, const char *scenario,
                       const char *data_dir, struct key_place place, double middle[3],
                       struct error_text *error);

#endif
