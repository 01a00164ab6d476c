/* The parts of a world that never change after its creation. struct world points into memory with
 * another owner: the shared segment, or a test's heap. */
#ifndef JOLON_WORLD_WORLD_H
#define JOLON_WORLD_WORLD_H

#include "world/terrain/terrain.h"

#include <stdint.h>

struct entities;
struct entity_name;
struct fixed_object;
struct formation;
struct hull;
struct hull_plane;
struct kind;
struct model;
struct model_triangle;
struct model_vertex;
struct mission;
struct battle_phase;
struct objective;
struct params;
struct script;
struct script_step;

struct area {
    double x0, z0, x1, z1;
};

struct route_point {
    double x, z;
};

struct route {
    uint32_t first, count; /* points */
    uint32_t once;         /* 1: of a mission; it ends at its last point */
    float bound_s;  /* [s] of a bound, in which every second vehicle stands; 0: none stands */
    float spread_m; /* vehicles pass a point within this distance of it, each its own */
    float last_x_m, last_z_m; /* the same at the last point: half of an area's sides */
};

/* A shot ordered by the scenario. */
struct fire_order {
    uint64_t tick;         /* when, in steps of simulated time */
    uint32_t shooter_slot; /* initial slot, SLOT_NONE: no vehicle of this world */
    uint32_t target_slot;  /* SLOT_NONE: the point */
    uint16_t kind;         /* munition, KIND_NONE: the shooter's own */
    uint16_t reserved;
    uint16_t rounds;   /* of a fire mission; 0: one shot */
    uint8_t fuze;      /* enum fuze; FUZE_COUNT: the munition's own */
    uint8_t high;      /* 1: along the higher of the two arcs */
    uint8_t adjusted;  /* 1: observers correct the fire */
    uint8_t unused[3]; /* 0 */
    double x, z;
    double bearing_rad; /* without a shooter: from which the round comes */
    double flight_s;    /* the same: from the tick to the impact */
};

struct road_point {
    double x, z;
    uint32_t road; /* the points of one road are consecutive */
    uint32_t reserved;
};

struct counts {
    uint32_t kinds, models, model_vertices, model_triangles;
    uint32_t hulls, hull_vertices, hull_planes;
    uint32_t posts_side, fixed, reach, areas, routes, route_points, fires, road_points, names;
    uint32_t formations, scripts, script_steps;
    uint32_t missions, mission_phases, mission_members, objectives;
    uint32_t earthworks, earthwork_words; /* of their index */
    uint32_t recipe;                      /* [byte] */
    uint32_t side_m;                      /* of the world: WORLD_SIDE_MIN_M .. MAX_M */
    uint32_t
        posts_in_file; /* 1: posts and cover are in a posts file (world/terrain/posts_file.h) */
};

struct world {
    const struct params *params;
    struct counts counts;
    struct terrain terrain;
    const struct kind *kinds;
    const struct model *models;
    const struct model_vertex *model_vertices;
    const struct model_triangle *model_triangles;
    const struct hull *hulls;
    const struct vec3 *hull_vertices;
    const struct hull_plane *hull_planes;
    const struct fixed_object *fixed;
    const uint32_t *reach_start; /* [terrain.squares.count + 1] into reach */
    const uint32_t *reach;       /* fixed object indices, ascending within a square */
    const struct area *areas;
    const struct route *routes;
    const struct route_point *route_points;
    const struct fire_order *fires; /* ascending tick */
    const struct road_point *road_points;
    const struct formation *formations;
    const struct script *scripts;
    const struct script_step *script_steps;
    const struct mission *missions;
    const struct battle_phase *mission_phases;
    const uint32_t *mission_members; /* initial slots, ascending within a mission */
    const struct objective *objectives;
    const struct entity_name *names; /* of the initial entities: slot i has id i + 1 */
    const char *recipe;              /* [counts.recipe] its provenance */
};

/* Returns a step of simulated time [s]: params->dt_s, for files that need no other parameter. */
double world_dt_s(const struct world *world);

/* Returns true if a place on the map is in the world, its edges included. False for NaN. */
static inline bool world_holds(const struct world *world, double x, double z)
{
    const double side_m = world->terrain.squares.world_m;
    return x >= 0.0 && z >= 0.0 && x <= side_m && z <= side_m;
}

/* Returns a coordinate of the map, or that of the nearest edge [m]. */
static inline double world_clamp(const struct world *world, double metres)
{
    return maths_clamp(metres, 0.0, world->terrain.squares.world_m);
}

/* Returns the name that the scenario gave the entity with this id, or "". */
const char *world_entity_name(const struct world *world, uint32_t id);

/* Returns the name of the entity in a row for people: that of the scenario, or the marking of one
 * of another simulator, which is written to marking (REMOTE_MARKING_MAX + 1 characters). "" for
 * none. */
const char *world_row_name(const struct world *world, const struct entities *e, uint32_t row,
                           char *marking);

/* Returns the id of the entity with this name in the scenario, 0 if there is none. */
uint32_t world_entity_named(const struct world *world, const char *name);

/* Returns the indices of the fixed objects that overlap a square. */
static inline uint32_t world_reach(const struct world *world, uint32_t square,
                                   const uint32_t **objects)
{
    *objects = world->reach + world->reach_start[square];
    return world->reach_start[square + 1] - world->reach_start[square];
}

#endif
