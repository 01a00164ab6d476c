/* A scenario as data: the content of the files that config/ read, before there is a world. Plain
 * memory owned by struct scenario; strings are bounded; references between parts are indices. */
#ifndef JOLON_WORLD_MAKING_SCENARIO_H
#define JOLON_WORLD_MAKING_SCENARIO_H

#include "world/entity/entity.h"
#include "world/entity/mission.h"
#include "world/entity/script.h"
#include "world/provenance.h"

#include <stdbool.h>
#include <stdint.h>

struct area;
struct earthwork;
struct hull;
struct hull_plane;
struct kind;
struct model;
struct model_triangle;
struct model_vertex;
struct route;
struct route_point;
struct vec3;

#define ROUTE_POINTS_MAX 1048576u /* of all routes together */

/* One entry of "vehicles": count of them in an area, or one at a place. */
struct scenario_group {
    char name[ENTITY_NAME_MAX];  /* "" for none; with count > 1, "-1", "-2", ... is appended */
    char squad[ENTITY_NAME_MAX]; /* the key "group"; "" for none */
    uint16_t kind;
    uint8_t force, behaviour;
    uint8_t flags;    /* ENTITY_FLAG_* */
    uint8_t roads;    /* 1: its route goes along roads */
    uint8_t formed;   /* 1: in a formation: leads it, or follows the previous group */
    uint8_t placed;   /* 1: at x, z; 0: anywhere in the area on suitable ground */
    uint8_t turned;   /* 1: heading_rad was given */
    uint8_t moving;   /* 1: speed_mps was given */
    uint8_t floating; /* 1: altitude_m was given */
    uint32_t count;
    uint32_t area;    /* index into areas */
    uint32_t route;   /* index into routes, UINT32_MAX for none */
    uint32_t script;  /* index into scripts, UINT32_MAX for none */
    uint32_t mission; /* 1 + index into missions, 0 for none */
    uint32_t shape;   /* enum formation_shape */
    int line;         /* of the file, for messages */
    double x, z, altitude_m, heading_rad, speed_mps, spacing_m;
};

/* A step of a script, as it is in the file. */
struct scenario_step {
    struct script_step step;      /* target_slot and order_arg are set when the world is built */
    char target[ENTITY_NAME_MAX]; /* its target's name */
    int line;                     /* of the script's file, for messages */
};

#define SCRIPT_STEPS_MAX 1048576u /* of all vehicles together */

struct scenario_script {
    char name[ENTITY_NAME_MAX];
    char file[SCRIPT_FILE_MAX]; /* of its waypoints, beside the scenario; "": in the scenario */
    uint32_t first, count;      /* steps */
    uint8_t reacts, repeats;
    int line;
};

/* A phase or reaction of a mission. Names have been looked up, except the phase's own route. */
struct scenario_phase {
    struct battle_phase phase; /* route, area: of the scenario's */
    double spread_m, bound_s;
    uint8_t roads; /* 1: the route goes along roads */
    int line;      /* of the file, for messages */
};

struct scenario_mission {
    struct mission mission;         /* first_phase: of the scenario's phases */
    char vehicles[ENTITY_NAME_MAX]; /* a group, or a beginning of names */
    uint8_t off_map;                /* 1: it has no vehicles */
    int line;
};

struct scenario_object {
    uint16_t kind;
    uint16_t turn; /* heading, 65536 for a full turn */
    float size;    /* relative to its kind's */
    double x, z;
};

struct scenario_fire {
    double at_s;
    char shooter[ENTITY_NAME_MAX]; /* "" for none: the round falls from the sky */
    char target[ENTITY_NAME_MAX];  /* "" for the point */
    uint16_t munition;             /* KIND_NONE: the shooter's own */
    uint16_t rounds;
    uint8_t fuze, adjusted, high, turned; /* turned: 1: bearing_rad was given */
    double x, z, bearing_rad;
    int line; /* of the file, for messages */
};

struct scenario {
    struct scenario_settings *settings; /* of its own */
    uint8_t based[FORCE_COUNT];         /* 1: settings->params.base was given */

    struct kind *kinds;
    uint32_t kind_count;
    struct model *models;
    uint32_t model_count;
    struct model_vertex *vertices;
    uint32_t vertex_count;
    struct model_triangle *triangles;
    uint32_t triangle_count;
    struct hull *hulls;
    uint32_t hull_count;
    struct vec3 *hull_vertices;
    uint32_t hull_vertex_count;
    struct hull_plane *hull_planes;
    uint32_t hull_plane_count;

    struct scenario_group *groups;
    uint32_t group_count;
    struct scenario_object *object_list;
    uint32_t object_count;
    struct earthwork *earthworks;
    uint32_t earthwork_count;
    struct scenario_fire *fires;
    uint32_t fire_count;
    struct area *areas;
    uint32_t area_count;
    struct scenario_script *scripts;
    uint32_t script_count;
    struct scenario_step *steps;
    uint32_t step_count;
    struct objective *objectives;
    uint32_t objective_count;
    struct scenario_mission *missions;
    uint32_t mission_count;
    struct scenario_phase *phases;
    uint32_t phase_count;
    struct route *routes;
    uint32_t route_count;
    struct route_point *route_points;
    uint32_t route_point_count;
    struct provenance recipe;
    /* Called now and then with the number of vehicles placed so far, and of all; may be NULL. */
    void (*placing)(uint32_t placed, uint32_t of);
};

void scenario_free(struct scenario *scenario);

#endif
