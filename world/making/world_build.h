/* Makes a world and its frame 0 from a scenario. Runs once, at creation, in one process. */
#ifndef JOLON_WORLD_MAKING_WORLD_BUILD_H
#define JOLON_WORLD_MAKING_WORLD_BUILD_H

#include "world/entity/entity.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/posts_file.h"
#include "world/terrain/terrain.h"
#include "world/world.h"

#include <stddef.h>
#include <stdint.h>

struct error_text;
struct fixed_object;
struct formation;
struct mission;
struct battle_phase;
struct scenario;
struct script;
struct script_step;

/* The generated parts in plain memory, from which counts (and so a segment's size) follow. */
struct world_build {
    const struct scenario *scenario;
    struct counts counts;
    float *posts;
    uint8_t *cover;
    struct posts_file posts_file; /* with counts.posts_in_file, in place of the two above */
    uint32_t *earthwork_index;
    struct fixed_object *fixed;
    uint32_t *reach_start, *reach;
    struct road_point *roads;
    struct fire_order *fires;
    struct route *routes;
    struct route_point *route_points;
    struct formation *formations;
    struct script *scripts;
    struct script_step *steps;
    struct mission *missions;
    struct battle_phase *phases;
    uint32_t *members;
    struct entity_name *names;
    struct force_base base[FORCE_COUNT];
    struct entities first; /* frame 0's entities, rows 0 .. used - 1 */
    void *first_memory;
    uint32_t used;
    uint32_t raised; /* aeroplanes that begin higher than the scenario says (start_height.h) */
};

/* 0, or -1 with error set: no room for the vehicles, an unknown name in
 * a fire order, no place found for a vehicle, out of memory. */
int world_build_make(struct world_build *built, const struct scenario *scenario,
                     struct error_text *error);
/* Returns the ground as built so far. */
struct terrain world_build_terrain(const struct world_build *built);

void world_build_free(struct world_build *built);

/* Copies everything into a world whose pointers lead to writable memory of the counts' sizes, and
 * frame 0 into both states. world->params must already hold scenario->params with built's
 * bases. */
void world_build_fill(const struct world_build *built, struct world *world, struct state state[2]);

#endif
