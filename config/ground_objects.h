/* Takes the objects and buildings of a ground file into a scenario: each building becomes a kind of
 * its own, with the hulls of its outline, and every object an entry of the scenario's list.
 * Start-up only. */
#ifndef JOLON_CONFIG_GROUND_OBJECTS_H
#define JOLON_CONFIG_GROUND_OBJECTS_H

#include "config/syntax/key_table.h"

struct scenario;

/* Reads the objects of settings->ground_file. Mass and resistance of a building are those of the
 * kind "building" times the ratio of their volumes, within GROUND_OBJECTS_RATIO times either way;
 * all else is as that kind has it. Needs the kinds building, tree, pine, bush, pole and watertower
 * where the file has such objects. place: of terrain.file, for messages. 0; -1 with the message. */
#define GROUND_OBJECTS_RATIO 50.0
int ground_objects_read(struct scenario *scenario, struct key_place place,
                        struct error_text *error);

#endif
