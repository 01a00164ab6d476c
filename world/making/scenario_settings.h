/* The groups of settings of a scenario: one value for each key. A new key of a group changes this
 * header or world/params.h, so only the .c files that read the settings include it. */
#ifndef JOLON_WORLD_MAKING_SCENARIO_SETTINGS_H
#define JOLON_WORLD_MAKING_SCENARIO_SETTINGS_H

#include "world/params.h"

#include <stdint.h>

#define GROUND_FILE_TEXT_MAX 1024

enum terrain_source { TERRAIN_GENERATED, TERRAIN_FLAT, TERRAIN_FILE };
enum object_source { OBJECTS_TABLE1, OBJECTS_NONE, OBJECTS_FILE, OBJECTS_LIST };

struct scenario_settings {
    struct params params;
    enum terrain_source terrain;
    double flat_height_m;
    double side_m;    /* of the world */
    double spacing_m; /* between posts of other ground than a file's: 125, 62.5 or 31.25 */
    char ground_file[GROUND_FILE_TEXT_MAX]; /* TERRAIN_FILE: its path, absolute */
    uint64_t ground_hash;                   /* the same: of the ground in it */
    enum object_source objects;
};

#endif
