/* Copies what was built into a world. Apart from world_build.c, because the roles of a set copy
 * tables of this shape but build none. */
#include "world/making/world_build.h"

#include "world/checksum.h"
#include "world/entity/formation.h"
#include "world/entity/hull.h"
#include "world/entity/kind.h"
#include "world/entity/mission.h"
#include "world/entity/script.h"
#include "world/making/scenario.h"
#include "world/model.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"

#include <string.h>

/* Static parts are const for everything except this one writer. */
static void fill(const void *to, const void *from, size_t count, size_t size)
{
    if (count > 0)
        memcpy((void *)(uintptr_t)to, from, count * size);
}

static void fill_state(const struct world_build *built, struct state *state)
{
    struct state_head *head = state->head;
    uint32_t vehicles = 0;
    *head = (struct state_head){.time_scale = 1.0,
                                .used = built->used,
                                .alloc_next = built->used,
                                .next_id = built->used + 1};
    entities_copy(&state->entities, &built->first, 0, built->used);
    for (uint32_t i = 0; i < built->used; i++)
        vehicles += built->first.row[i].state != ENTITY_FREE;
    head->vehicles = vehicles;
    memset(state->fixed_damage, DAMAGE_NONE, built->counts.fixed);
    state_seal(state, built->counts.fixed);
}

void world_build_fill(const struct world_build *built, struct world *world, struct state state[2])
{
    const struct scenario *s = built->scenario;
    const struct counts *n = &built->counts;
    size_t posts = n->posts_in_file ? 0 : (size_t)n->posts_side * n->posts_side;
    fill(world->kinds, s->kinds, n->kinds, sizeof *s->kinds);
    fill(world->models, s->models, n->models, sizeof *s->models);
    fill(world->model_vertices, s->vertices, n->model_vertices, sizeof *s->vertices);
    fill(world->model_triangles, s->triangles, n->model_triangles, sizeof *s->triangles);
    fill(world->hulls, s->hulls, n->hulls, sizeof *s->hulls);
    fill(world->hull_vertices, s->hull_vertices, n->hull_vertices, sizeof *s->hull_vertices);
    fill(world->hull_planes, s->hull_planes, n->hull_planes, sizeof *s->hull_planes);
    fill(world->terrain.posts, built->posts, posts, sizeof *built->posts);
    fill(world->terrain.cover, built->cover, posts, 1);
    fill(world->terrain.earthworks.works, s->earthworks, n->earthworks, sizeof *s->earthworks);
    fill(world->terrain.earthworks.index, built->earthwork_index, n->earthwork_words,
         sizeof *built->earthwork_index);
    fill(world->fixed, built->fixed, n->fixed, sizeof *built->fixed);
    fill(world->reach_start, built->reach_start, world->terrain.squares.count + 1,
         sizeof(uint32_t));
    fill(world->reach, built->reach, n->reach, sizeof(uint32_t));
    fill(world->areas, s->areas, n->areas, sizeof *s->areas);
    fill(world->routes, built->routes, n->routes, sizeof *built->routes);
    fill(world->route_points, built->route_points, n->route_points, sizeof *built->route_points);
    fill(world->fires, built->fires, n->fires, sizeof *built->fires);
    fill(world->road_points, built->roads, n->road_points, sizeof *built->roads);
    fill(world->formations, built->formations, n->formations, sizeof *built->formations);
    fill(world->scripts, built->scripts, n->scripts, sizeof *built->scripts);
    fill(world->script_steps, built->steps, n->script_steps, sizeof *built->steps);
    fill(world->missions, built->missions, n->missions, sizeof *built->missions);
    fill(world->mission_phases, built->phases, n->mission_phases, sizeof *built->phases);
    fill(world->mission_members, built->members, n->mission_members, sizeof *built->members);
    fill(world->objectives, s->objectives, n->objectives, sizeof *s->objectives);
    fill(world->names, built->names, n->names, sizeof *built->names);
    fill(world->recipe, s->recipe.text, s->recipe.bytes, 1);
    for (int i = 0; i < 2; i++)
        fill_state(built, &state[i]);
}
