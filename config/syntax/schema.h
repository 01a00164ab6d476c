/* The schema: every key of the files of scenarios and kinds, its type, range, default, meaning and
 * destination. A scenario's groups are read into struct scenario_settings. Entries of lists and
 * kinds are read into the structs below; the names in them are looked up afterwards.
 *
 * To add a key, add a member to its destination (struct params or struct scenario_settings for a
 * scenario's groups) and a row to its table. Show it in an example of docs/scenario.md, and run
 * `make docs`. */
#ifndef JOLON_CONFIG_SYNTAX_SCHEMA_H
#define JOLON_CONFIG_SYNTAX_SCHEMA_H

#include "config/syntax/key_table.h"
#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/entity/mission.h"
#include "world/entity/script.h"

/* Limits of files. They are checked before memory of that size is allocated. */
#define SCHEMA_SCENARIO_BYTES_MAX (4u * 1024u * 1024u)
#define SCHEMA_KIND_BYTES_MAX     (64u * 1024u)
#define SCHEMA_DEPTH_MAX          8u            /* levels of groups, lists and arrays */
#define SCHEMA_MEMBERS_MAX        KEY_TABLE_MAX /* keys of one group */

#define SCHEMA_GROUPS_MAX  65536
#define SCHEMA_OBJECTS_MAX 1048576
#define SCHEMA_SCRIPTS_MAX 65536
#define SCHEMA_FIRES_MAX   65536
/* The largest whole number up to which all are exact in a double, the number of JSON. */
#define SCHEMA_WHOLE_MAX 9007199254740991.0

/* Destination: struct scenario_settings. These are the keys that an override can set. */
extern const struct key_table schema_scenario;

/* Rows of schema_vehicle, for key_reading.given and .line. */
enum vehicle_key {
    VEHICLE_KIND,
    VEHICLE_COUNT,
    VEHICLE_FORCE,
    VEHICLE_BEHAVIOUR,
    VEHICLE_AREA,
    VEHICLE_ROUTE,
    VEHICLE_ROADS,
    VEHICLE_SCRIPT,
    VEHICLE_NAME,
    VEHICLE_GROUP,
    VEHICLE_AT,
    VEHICLE_ALTITUDE,
    VEHICLE_HEADING,
    VEHICLE_SPEED,
    VEHICLE_FIRE_AT_WILL,
    VEHICLE_ENGAGE,
    VEHICLE_STAND,
    VEHICLE_FORMATION,
    VEHICLE_SPACING,
    VEHICLE_KEY_COUNT
};

struct vehicle_entry {
    char kind[KIND_NAME_MAX];
    char name[ENTITY_NAME_MAX];
    char group[ENTITY_NAME_MAX];
    uint32_t count;
    uint32_t force, behaviour;
    uint32_t fire_at_will;
    uint32_t engage; /* ENTITY_FLAG_*; 0: it returns fire */
    uint32_t stand;
    uint32_t formation;
    double spacing_m;
    double area[4];
    double at[2];
    const config_setting_t *route;
    uint32_t roads;
    char script[ENTITY_NAME_MAX];
    double altitude_m, heading_rad, speed_mps;
};
extern const struct key_table schema_vehicle;

enum script_key { SCRIPT_NAME, SCRIPT_FILE, SCRIPT_REPEAT, SCRIPT_REACT, SCRIPT_KEY_COUNT };

struct script_entry {
    char name[ENTITY_NAME_MAX];
    char file[SCRIPT_FILE_MAX];
    uint32_t repeat, react;
};
extern const struct key_table schema_script;

enum step_key {
    STEP_KEY_AT,
    STEP_KEY_AFTER,
    STEP_KEY_GO,
    STEP_KEY_ARRIVE,
    STEP_KEY_FACE,
    STEP_KEY_STOP,
    STEP_KEY_WAIT,
    STEP_KEY_FIRE,
    STEP_KEY_FIRE_AT,
    STEP_KEY_BEHAVIOUR,
    STEP_KEY_THROTTLE,
    STEP_KEY_STEER,
    STEP_KEY_CLIMB,
    STEP_KEY_FOR,
    STEP_KEY_SPEED,
    STEP_KEY_ALTITUDE,
    STEP_KEY_COUNT
};

struct step_entry {
    double at_s, after_s;
    double go[2], arrive[2], fire_at[2];
    double face_rad, wait_s, for_s, speed_mps, altitude_m;
    double throttle, steer, climb;
    uint32_t stop, behaviour;
    char fire[ENTITY_NAME_MAX];
};
extern const struct key_table schema_step;

enum objective_key { OBJECTIVE_NAME, OBJECTIVE_AREA, OBJECTIVE_FORCE, OBJECTIVE_KEY_COUNT };

struct objective_entry {
    char name[ENTITY_NAME_MAX];
    double area[4];
    uint32_t force;
};
extern const struct key_table schema_objective;

enum mission_key {
    MISSION_KEY_NAME,
    MISSION_KEY_VEHICLES,
    MISSION_KEY_OFF_MAP,
    MISSION_KEY_FORCE,
    MISSION_KEY_COUNT
};

struct mission_entry {
    char name[ENTITY_NAME_MAX];
    char vehicles[ENTITY_NAME_MAX];
    uint32_t off_map, force;
};
extern const struct key_table schema_mission;

enum phase_key {
    PHASE_NAME,
    PHASE_ORDER,
    PHASE_TO,
    PHASE_ROUTE,
    PHASE_ROADS,
    PHASE_AREA,
    PHASE_OBJECTIVE,
    PHASE_SPREAD,
    PHASE_BOUND,
    PHASE_ENGAGE,
    PHASE_MUNITION,
    PHASE_RATE,
    PHASE_ADJUST,
    PHASE_BEARING,
    PHASE_AT_LEAST,
    PHASE_ALL,
    PHASE_FOR,
    PHASE_UNTIL,
    PHASE_ARRIVED,
    PHASE_TAKEN,
    PHASE_LOST,
    PHASE_BELOW,
    PHASE_ENEMY_IN,
    PHASE_AFTER,
    PHASE_NOT,
    PHASE_WHEN_ALL,
    PHASE_WHEN_NOT,
    PHASE_WHEN_TIME,
    PHASE_WHEN_TAKEN,
    PHASE_WHEN_LOST,
    PHASE_WHEN_BELOW,
    PHASE_WHEN_ENEMY_IN,
    PHASE_WHEN_AFTER,
    PHASE_KEY_COUNT
};

#define SCHEMA_AFTER_MAX 48 /* [byte] "mission.phase", with the NUL */

#define SCHEMA_NOT_MAX 80 /* [byte] names of keys, with spaces between them */

/* Names of one set of conditions, and its numbers. */
struct condition_entry {
    double for_s, at_s, arrived, below;
    char taken[ENTITY_NAME_MAX], lost[ENTITY_NAME_MAX], enemy_in[ENTITY_NAME_MAX];
    char after[SCHEMA_AFTER_MAX];
    uint32_t all;
    char unless[SCHEMA_NOT_MAX];
};

struct phase_entry {
    char name[ENTITY_NAME_MAX];
    char objective[ENTITY_NAME_MAX];
    char munition[KIND_NAME_MAX];
    uint32_t order, engage, roads;
    double to[2], area[4];
    const config_setting_t *route;
    double spread_m, bound_s, rounds_a_minute, bearing_rad, at_least_s;
    uint32_t adjust;
    struct condition_entry until, when;
};
extern const struct key_table schema_phase;

enum earthwork_key {
    EARTHWORK_KEY_SHAPE,
    EARTHWORK_KEY_AT,
    EARTHWORK_KEY_HEADING,
    EARTHWORK_KEY_LENGTH,
    EARTHWORK_KEY_WIDTH,
    EARTHWORK_KEY_HEIGHT,
    EARTHWORK_KEY_DEPTH,
    EARTHWORK_KEY_EDGE,
    EARTHWORK_KEY_GRADE,
    EARTHWORK_KEY_WAVE,
    EARTHWORK_KEY_GRIP,
    EARTHWORK_KEY_COUNT
};

struct earthwork_entry {
    uint32_t shape; /* enum earthwork_shape */
    double at[2];
    double heading_rad, length_m, width_m, height_m, depth_m, edge_m;
    double grade; /* a tangent */
    double wave_m, grip;
};
extern const struct key_table schema_earthwork;

enum base_key { BASE_FORCE, BASE_AT, BASE_KEY_COUNT };

struct base_entry {
    uint32_t force;
    double at[2];
};
extern const struct key_table schema_base;

enum object_key { OBJECT_KEY_KIND, OBJECT_KEY_AT, OBJECT_KEY_HEADING, OBJECT_KEY_COUNT };

struct object_entry {
    char kind[KIND_NAME_MAX];
    double at[2];
    double heading_rad;
};
extern const struct key_table schema_object;

enum fire_key {
    FIRE_AT,
    FIRE_SHOOTER,
    FIRE_TARGET,
    FIRE_MUNITION,
    FIRE_POINT,
    FIRE_ROUNDS,
    FIRE_ADJUST,
    FIRE_FUZE,
    FIRE_HIGH,
    FIRE_BEARING,
    FIRE_KEY_COUNT
};

struct fire_entry {
    double at_s;
    char shooter[ENTITY_NAME_MAX];
    char target[ENTITY_NAME_MAX];
    char munition[KIND_NAME_MAX];
    double point[2];
    uint32_t rounds, fuze, adjust, high;
    double bearing_rad;
};
extern const struct key_table schema_fire;

struct kind_entry {
    struct kind kind;
    char model[KIND_NAME_MAX];
    char munition[KIND_NAME_MAX]; /* "": none */
    char light_munition[KIND_NAME_MAX];
};
extern const struct key_table schema_kind;

#endif
