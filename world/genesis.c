/* From a scenario to a world's static parts and its frame 0. */
#include "world/genesis.h"

#include "world/generate.h"
#include "world/place.h"
#include "world/random.h"
#include "world/reach.h"
#include "world/square.h"
#include "world/checksum.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct complaint {
    char *text;
    size_t bytes;
};

__attribute__((format(printf, 2, 3))) static int complain(const struct complaint *to,
                                                          const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(to->text, to->bytes, format, args);
    va_end(args);
    return -1;
}

static int out_of_memory(const struct complaint *to)
{
    return complain(to, "out of memory while making the world");
}

static struct terrain terrain_of(const struct genesis *genesis)
{
    return (struct terrain){genesis->posts, genesis->cover, genesis->counts.posts_side,
                            WORLD_SIDE_M / (double)(genesis->counts.posts_side - 1)};
}

static int build_ground(struct genesis *genesis, const struct complaint *to)
{
    const struct scenario *scenario = genesis->scenario;
    uint32_t side = (uint32_t)(WORLD_SIDE_M / scenario->spacing_m) + 1;
    size_t posts = (size_t)side * side;
    genesis->counts.posts_side = side;
    genesis->posts = malloc(posts * sizeof *genesis->posts);
    genesis->cover = malloc(posts);
    genesis->roads = malloc(GENERATE_ROAD_MAX * sizeof *genesis->roads);
    if (!genesis->posts || !genesis->cover || !genesis->roads)
        return out_of_memory(to);
    if (scenario->terrain == TERRAIN_FLAT) {
        generate_flat(genesis->posts, genesis->cover, side, scenario->flat_height_m);
        return 0;
    }
    if (generate_hunter_liggett(genesis->posts, genesis->cover, side, scenario->params.seed,
                                genesis->roads, GENERATE_ROAD_MAX,
                                &genesis->counts.road_points) != 0)
        return complain(to, "the ground could not be generated: %s", strerror(errno));
    return 0;
}

static int by_square(const void *a, const void *b)
{
    const struct fixed_object *p = a, *q = b;
    uint32_t sp = square_of(p->x, p->z), sq = square_of(q->x, q->z);
    if (sp != sq)
        return sp < sq ? -1 : 1;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    if (p->z != q->z)
        return p->z < q->z ? -1 : 1;
    return p->kind < q->kind ? -1 : p->kind > q->kind;
}

static void list_objects(struct genesis *genesis, const struct terrain *terrain)
{
    const struct scenario *scenario = genesis->scenario;
    for (uint32_t i = 0; i < scenario->object_count; i++) {
        const struct scenario_object *from = &scenario->object_list[i];
        const struct kind *kind = &scenario->kinds[from->kind];
        genesis->fixed[i] = (struct fixed_object){
            .x = from->x,
            .z = from->z,
            .y = (float)terrain_base_height(terrain, from->x, from->z),
            .radius_m = (float)kind->radius_m,
            .height_m = (float)kind->height_m,
            .kind = from->kind,
            .turn = (uint16_t)(maths_wrap_turn(from->heading_rad) * (65536.0 / TWO_PI)),
        };
    }
    qsort(genesis->fixed, scenario->object_count, sizeof *genesis->fixed, by_square);
}

static int build_objects(struct genesis *genesis, const struct complaint *to)
{
    const struct scenario *scenario = genesis->scenario;
    struct terrain terrain = terrain_of(genesis);
    uint32_t count = scenario->objects == OBJECTS_TABLE1 ? GENERATE_TABLE1_TOTAL
                     : scenario->objects == OBJECTS_LIST ? scenario->object_count
                                                         : 0;
    genesis->counts.fixed = count;
    genesis->fixed = calloc(count + 1, sizeof *genesis->fixed);
    if (!genesis->fixed)
        return out_of_memory(to);
    if (scenario->objects == OBJECTS_LIST)
        list_objects(genesis, &terrain);
    if (scenario->objects == OBJECTS_TABLE1 &&
        generate_table1_objects(genesis->fixed, &terrain, scenario->kinds, scenario->kind_count,
                                genesis->roads, genesis->counts.road_points,
                                scenario->params.seed) != 0)
        return errno == EINVAL
                   ? complain(to, "objects: a class of Table 1 has no kind in config/kinds")
                   : out_of_memory(to);
    if (reach_build(genesis->fixed, count, scenario->kinds, &genesis->reach_start,
                    &genesis->reach) != 0)
        return out_of_memory(to);
    genesis->counts.reach = genesis->reach_start[SQUARE_COUNT];
    return 0;
}

static void place_entity(struct genesis *genesis, const struct scenario_group *group, uint32_t slot,
                         double x, double z)
{
    const struct scenario *scenario = genesis->scenario;
    const struct kind *kind = &scenario->kinds[group->kind];
    struct terrain terrain = terrain_of(genesis);
    struct entities *e = &genesis->first;
    double altitude = group->floating ? group->altitude_m : kind->cruise_altitude_m;
    double heading =
        group->turned ? maths_wrap_turn(group->heading_rad)
                      : random_between(scenario->params.seed, 0, slot, RANDOM_HEADING, 0, TWO_PI);
    double speed = group->moving ? group->speed_mps : kind->min_speed_mps;
    double sine, cosine;
    maths_sincos(heading, &sine, &cosine);
    e->id[slot] = slot + 1;
    e->state[slot] = ENTITY_ACTIVE;
    e->kind[slot] = group->kind;
    e->force[slot] = group->force;
    e->behaviour[slot] = e->order[slot] = group->behaviour;
    e->order_arg[slot] = group->behaviour == BEHAVIOUR_ROUTE ? group->route : group->area;
    e->flags[slot] = group->fire_at_will ? ENTITY_FLAG_FIRE_AT_WILL : 0;
    e->x[slot] = x;
    e->z[slot] = z;
    e->y[slot] =
        terrain_base_height(&terrain, x, z) + (kind->domain == DOMAIN_AIR ? altitude : 0.0);
    e->heading[slot] = heading;
    e->vx[slot] = speed * sine;
    e->vz[slot] = -speed * cosine;
    e->fuel_l[slot] = kind->fuel_l;
    e->rounds[slot] = kind->rounds;
    e->goal_x[slot] = x; /* reached: the mover's first think chooses the next */
    e->goal_z[slot] = z;
}

static int build_group(struct genesis *genesis, const struct scenario_group *group,
                       struct place *place, const struct complaint *to)
{
    const struct scenario *scenario = genesis->scenario;
    for (uint32_t i = 0; i < group->count; i++) {
        uint32_t slot = genesis->used;
        double x = group->x, z = group->z;
        if (slot >= scenario->params.capacity)
            return complain(to,
                            "vehicles: more than world.capacity = %u; raise it (at most %u) or "
                            "lower a count",
                            scenario->params.capacity, CAPACITY_MAX);
        if (!group->placed && place_find(place, &scenario->areas[group->area],
                                         &scenario->kinds[group->kind], slot, &x, &z) != 0)
            return complain(to,
                            "vehicles: no place for %s number %u of %u in area [%.0f, %.0f, %.0f, "
                            "%.0f]: too crowded, or the wrong ground for its domain",
                            scenario->kinds[group->kind].name, i + 1, group->count,
                            scenario->areas[group->area].x0, scenario->areas[group->area].z0,
                            scenario->areas[group->area].x1, scenario->areas[group->area].z1);
        if (place_take(place, x, z, reach_of_kind(&scenario->kinds[group->kind])) != 0)
            return out_of_memory(to);
        place_entity(genesis, group, slot, x, z);
        if (group->name[0] != '\0')
            snprintf(genesis->names[slot].text, ENTITY_NAME_MAX,
                     group->count > 1 ? "%.15s-%u" : "%s", group->name, i + 1);
        genesis->used++;
    }
    return 0;
}

static int build_entities(struct genesis *genesis, const struct complaint *to)
{
    const struct scenario *scenario = genesis->scenario;
    uint32_t capacity = scenario->params.capacity;
    struct terrain terrain = terrain_of(genesis);
    struct place place;
    int result = 0;
    genesis->first_memory = aligned_alloc(COLUMN_ALIGN, entities_bytes(capacity));
    genesis->names = calloc(capacity, sizeof *genesis->names);
    if (!genesis->first_memory || !genesis->names)
        return out_of_memory(to);
    memset(genesis->first_memory, 0, entities_bytes(capacity));
    entities_bind(&genesis->first, capacity, genesis->first_memory);
    if (place_init(&place, &terrain, genesis->fixed, scenario->kinds, genesis->reach_start,
                   genesis->reach, scenario->params.seed) != 0)
        return out_of_memory(to);
    for (uint32_t g = 0; g < scenario->group_count && result == 0; g++)
        result = build_group(genesis, &scenario->groups[g], &place, to);
    place_free(&place);
    genesis->counts.names = genesis->used;
    return result;
}

static int by_name(const void *a, const void *b)
{
    const struct entity_name *const *p = a, *const *q = b;
    int order = strncmp((*p)->text, (*q)->text, ENTITY_NAME_MAX);
    return order != 0 ? order : (*p > *q) - (*p < *q);
}

/* The vehicles' names in their order: orders may be as many as vehicles. NULL: out of memory. */
static const struct entity_name **sort_names(const struct genesis *genesis)
{
    const struct entity_name **sorted = calloc(genesis->used + 1, sizeof(void *));
    if (!sorted)
        return NULL;
    for (uint32_t i = 0; i < genesis->used; i++)
        sorted[i] = &genesis->names[i];
    qsort(sorted, genesis->used, sizeof(void *), by_name);
    return sorted;
}

static int find_name(const struct genesis *genesis, const struct entity_name **sorted,
                     const char *name, uint32_t *slot)
{
    uint32_t low = 0, high = genesis->used;
    *slot = SLOT_NONE;
    if (name[0] == '\0')
        return 0;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (strncmp(sorted[middle]->text, name, ENTITY_NAME_MAX) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == genesis->used || strncmp(sorted[low]->text, name, ENTITY_NAME_MAX) != 0)
        return -1;
    *slot = (uint32_t)(sorted[low] - genesis->names);
    return 0;
}

static int by_tick(const void *a, const void *b)
{
    const struct fire_order *p = a, *q = b;
    if (p->tick != q->tick)
        return p->tick < q->tick ? -1 : 1;
    return p->reserved < q->reserved ? -1 : p->reserved > q->reserved; /* the file's order */
}

static int build_fire(struct genesis *genesis, uint32_t index, const struct entity_name **sorted,
                      const struct complaint *to)
{
    const struct scenario *scenario = genesis->scenario;
    const struct scenario_fire *from = &scenario->fires[index];
    struct fire_order *order = &genesis->fires[index];
    double tick = floor(from->at_s * scenario->params.hz + 0.5);
    order->tick = tick < 1.0 ? 1 : (uint64_t)tick;
    order->kind = from->munition;
    order->reserved = (uint16_t)index;
    order->x = from->x;
    order->z = from->z;
    if (find_name(genesis, sorted, from->shooter, &order->shooter_slot) != 0)
        return complain(to, "%s:%d: fires.shooter = \"%s\": no vehicle has that name",
                        scenario->params.scenario, from->line, from->shooter);
    if (find_name(genesis, sorted, from->target, &order->target_slot) != 0)
        return complain(to, "%s:%d: fires.target = \"%s\": no vehicle has that name",
                        scenario->params.scenario, from->line, from->target);
    return 0;
}

static int build_fires(struct genesis *genesis, const struct complaint *to)
{
    uint32_t count = genesis->scenario->fire_count;
    int result = 0;
    genesis->fires = calloc(count + 1, sizeof *genesis->fires);
    const struct entity_name **sorted = sort_names(genesis);
    if (!genesis->fires || !sorted) {
        free(sorted);
        return out_of_memory(to);
    }
    for (uint32_t i = 0; i < count && result == 0; i++)
        result = build_fire(genesis, i, sorted, to);
    free(sorted);
    if (result != 0)
        return -1;
    qsort(genesis->fires, count, sizeof *genesis->fires, by_tick);
    genesis->counts.fires = count;
    return 0;
}

int genesis_build(struct genesis *genesis, const struct scenario *scenario, char *text,
                  size_t bytes)
{
    struct complaint to = {text, bytes};
    *genesis = (struct genesis){.scenario = scenario};
    genesis->counts = (struct counts){
        .kinds = scenario->kind_count,
        .models = scenario->model_count,
        .model_vertices = scenario->vertex_count,
        .model_triangles = scenario->triangle_count,
        .hulls = scenario->hull_count,
        .hull_vertices = scenario->hull_vertex_count,
        .hull_planes = scenario->hull_plane_count,
        .areas = scenario->area_count,
        .routes = scenario->route_count,
        .route_points = scenario->route_point_count,
        .recipe = recipe_room(scenario->recipe.bytes),
    };
    if (build_ground(genesis, &to) != 0 || build_objects(genesis, &to) != 0 ||
        build_entities(genesis, &to) != 0 || build_fires(genesis, &to) != 0) {
        genesis_free(genesis);
        return -1;
    }
    return 0;
}

void genesis_free(struct genesis *genesis)
{
    free(genesis->posts);
    free(genesis->cover);
    free(genesis->fixed);
    free(genesis->reach_start);
    free(genesis->reach);
    free(genesis->roads);
    free(genesis->fires);
    free(genesis->names);
    free(genesis->first_memory);
    *genesis = (struct genesis){0};
}

/* Static parts are const to everybody after this one writer. */
static void fill(const void *to, const void *from, size_t count, size_t size)
{
    if (count > 0)
        memcpy((void *)(uintptr_t)to, from, count * size);
}

static void fill_state(const struct genesis *genesis, struct state *state)
{
    struct state_head *head = state->head;
    uint32_t vehicles = 0;
    *head = (struct state_head){.time_scale = 1.0,
                                .used = genesis->used,
                                .alloc_next = genesis->used,
                                .next_id = genesis->used + 1};
    entities_copy(&state->entities, &genesis->first, 0, genesis->used);
    for (uint32_t i = 0; i < genesis->used; i++)
        vehicles += genesis->first.state[i] != ENTITY_FREE;
    head->vehicles = vehicles;
    memset(state->fixed_damage, DAMAGE_NONE, genesis->counts.fixed);
    head->checksum = state_checksum(state, genesis->counts.fixed);
}

void genesis_fill(const struct genesis *genesis, struct world *world, struct state state[2])
{
    const struct scenario *s = genesis->scenario;
    const struct counts *n = &genesis->counts;
    size_t posts = (size_t)n->posts_side * n->posts_side;
    fill(world->kinds, s->kinds, n->kinds, sizeof *s->kinds);
    fill(world->models, s->models, n->models, sizeof *s->models);
    fill(world->model_vertices, s->vertices, n->model_vertices, sizeof *s->vertices);
    fill(world->model_triangles, s->triangles, n->model_triangles, sizeof *s->triangles);
    fill(world->hulls, s->hulls, n->hulls, sizeof *s->hulls);
    fill(world->hull_vertices, s->hull_vertices, n->hull_vertices, sizeof *s->hull_vertices);
    fill(world->hull_planes, s->hull_planes, n->hull_planes, sizeof *s->hull_planes);
    fill(world->terrain.posts, genesis->posts, posts, sizeof *genesis->posts);
    fill(world->terrain.cover, genesis->cover, posts, 1);
    fill(world->fixed, genesis->fixed, n->fixed, sizeof *genesis->fixed);
    fill(world->reach_start, genesis->reach_start, SQUARE_COUNT + 1, sizeof(uint32_t));
    fill(world->reach, genesis->reach, n->reach, sizeof(uint32_t));
    fill(world->areas, s->areas, n->areas, sizeof *s->areas);
    fill(world->routes, s->routes, n->routes, sizeof *s->routes);
    fill(world->route_points, s->route_points, n->route_points, sizeof *s->route_points);
    fill(world->fires, genesis->fires, n->fires, sizeof *genesis->fires);
    fill(world->road_points, genesis->roads, n->road_points, sizeof *genesis->roads);
    fill(world->names, genesis->names, n->names, sizeof *genesis->names);
    fill(world->recipe, s->recipe.text, s->recipe.bytes, 1);
    for (int i = 0; i < 2; i++)
        fill_state(genesis, &state[i]);
}
