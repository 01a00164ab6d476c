/* From a scenario to a world's static parts and its frame 0. */
#include "world/making/world_build.h"

#include "world/entity/formation.h"
#include "world/entity/hull.h"
#include "world/entity/kind.h"
#include "world/entity/mission.h"
#include "world/entity/script.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/maths/maths.h"
#include "world/maths/random.h"
#include "world/model.h"
#include "world/runtime/error_text.h"
#include "world/making/generate.h"
#include "world/making/ground_load.h"
#include "world/making/plant_placement.h"
#include "world/making/mission_build.h"
#include "world/making/vehicle_placement.h"
#include "world/terrain/fixed_index.h"
#include "world/making/road_routing.h"
#include "world/name_index.h"
#include "world/making/script_build.h"
#include "world/terrain/gridsquare.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A shell from off the map is seen for so long before it strikes. */
#define APPROACH_S 6.0

static int build_ground(struct world_build *built, struct error_text *error)
{
    const struct scenario *scenario = built->scenario;
    if (scenario->settings->terrain == TERRAIN_FILE)
        return ground_load(built, error);
    uint32_t side = (uint32_t)(scenario->settings->side_m / scenario->settings->spacing_m) + 1;
    size_t posts = (size_t)side * side;
    built->counts.posts_side = side;
    built->posts = malloc(posts * sizeof *built->posts);
    built->cover = malloc(posts);
    built->roads = malloc(GENERATE_ROAD_MAX * sizeof *built->roads);
    if (!built->posts || !built->cover || !built->roads)
        return error_text_memory(error);
    if (scenario->settings->terrain == TERRAIN_FLAT) {
        generate_flat(built->posts, built->cover, side, scenario->settings->flat_height_m);
        return 0;
    }
    if (generate_hunter_liggett(built->posts, built->cover, side, scenario->settings->params.seed,
                                built->roads, GENERATE_ROAD_MAX, &built->counts.road_points) != 0)
        return error_text_set(error, "%s: the ground could not be generated: %s",
                              scenario->settings->params.scenario, strerror(errno));
    return 0;
}

static int build_earthworks(struct world_build *built, struct error_text *error)
{
    const struct scenario *scenario = built->scenario;
    const struct gridsquares squares = gridsquares_of(built->counts.side_m);
    if (earthwork_index_build(scenario->earthworks, scenario->earthwork_count, &squares,
                              &built->earthwork_index, &built->counts.earthwork_words) != 0)
        return error_text_memory(error);
    built->counts.earthworks = scenario->earthwork_count;
    return 0;
}

static int by_square(const void *a, const void *b, void *squares)
{
    const struct fixed_object *p = a, *q = b;
    uint32_t sp = gridsquare_of(squares, p->x, p->z), sq = gridsquare_of(squares, q->x, q->z);
    if (sp != sq)
        return sp < sq ? -1 : 1;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    if (p->z != q->z)
        return p->z < q->z ? -1 : 1;
    return p->kind < q->kind ? -1 : p->kind > q->kind;
}

static void list_objects(struct world_build *built, const struct terrain *terrain)
{
    const struct scenario *scenario = built->scenario;
    for (uint32_t i = 0; i < scenario->object_count; i++) {
        const struct scenario_object *from = &scenario->object_list[i];
        const struct kind *kind = &scenario->kinds[from->kind];
        built->fixed[i] = (struct fixed_object){
            .x = from->x,
            .z = from->z,
            .y = (float)terrain_base_height(terrain, from->x, from->z),
            .radius_m = (float)(kind->radius_m * (double)from->size),
            .height_m = (float)(kind->height_m * (double)from->size),
            .kind = from->kind,
            .turn = from->turn,
        };
    }
    struct gridsquares squares = terrain->squares;
    qsort_r(built->fixed, scenario->object_count, sizeof *built->fixed, by_square, &squares);
}

/* Says why Table 1 could not be planted, by errno. */
static int tell_objects(const char *file, struct error_text *error)
{
    if (errno == EINVAL)
        return error_text_set(error, "%s: objects: a class of Table 1 has no kind in config/kinds",
                              file);
    if (errno == ENOSPC)
        return error_text_set(
            error,
            "%s: objects.source = table1: the ground has no room for the %u objects "
            "of Table 1, which need %u gridsquares of dry land without roads; "
            "right would be file, none, or a list of objects",
            file, GENERATE_TABLE1_TOTAL, PLANT_PLACEMENT_SQUARES);
    return error_text_memory(error);
}

static int build_objects(struct world_build *built, struct error_text *error)
{
    const struct scenario *scenario = built->scenario;
    struct terrain terrain = world_build_terrain(built);
    uint32_t count = scenario->settings->objects == OBJECTS_TABLE1 ? GENERATE_TABLE1_TOTAL
                                                                   : scenario->object_count;
    built->counts.fixed = count;
    built->fixed = calloc(count + 1, sizeof *built->fixed);
    if (!built->fixed)
        return error_text_memory(error);
    if (scenario->settings->objects != OBJECTS_TABLE1)
        list_objects(built, &terrain);
    if (scenario->settings->objects == OBJECTS_TABLE1 &&
        generate_table1_objects(built->fixed, &terrain, scenario->kinds, scenario->kind_count,
                                built->roads, built->counts.road_points,
                                scenario->settings->params.seed) != 0)
        return tell_objects(scenario->settings->params.scenario, error);
    if (fixed_index_build(&terrain.squares, built->fixed, count, scenario->kinds,
                          &built->reach_start, &built->reach) != 0)
        return error_text_memory(error);
    built->counts.reach = built->reach_start[terrain.squares.count];
    return 0;
}

static int by_tick(const void *a, const void *b)
{
    const struct fire_order *p = a, *q = b;
    if (p->tick != q->tick)
        return p->tick < q->tick ? -1 : 1;
    return p->reserved < q->reserved
               ? -1
               : p->reserved > q->reserved; /* equal ones in the order of the file */
}

/* A shell from off the map appears on its arc so long before its time that it strikes then. */
static void begin_approach(struct fire_order *order, double hz)
{
    uint64_t frames = (uint64_t)(APPROACH_S * hz);
    frames = order->tick > frames ? frames : order->tick - 1;
    order->tick -= frames;
    order->flight_s = (double)frames / hz;
}

#define NO_SUCH_NAME                                                                               \
    "%s:%d: fires[%u].%s = \"%s\": no vehicle has that name; right would be: a name that "         \
    "vehicles "                                                                                    \
    "gives, of a group with a number: \"NAME-1\""

static int build_fire(struct world_build *built, uint32_t index, const struct name_index *names,
                      struct error_text *error)
{
    const struct scenario *scenario = built->scenario;
    const struct scenario_fire *from = &scenario->fires[index];
    struct fire_order *order = &built->fires[index];
    double tick = floor(from->at_s * scenario->settings->params.hz + 0.5);
    order->tick = tick < 1.0 ? 1 : (uint64_t)tick;
    order->rounds = from->rounds;
    order->fuze = from->fuze;
    order->high = from->high;
    order->adjusted = from->adjusted;
    order->bearing_rad = from->turned ? from->bearing_rad
                                      : TWO_PI * random_unit(scenario->settings->params.seed, index,
                                                             0, RANDOM_MEAN_AZIMUTH);
    order->kind = from->munition;
    order->reserved = (uint16_t)index;
    order->x = from->x;
    order->z = from->z;
    if (name_index_find(names, from->shooter, &order->shooter_slot) != 0)
        return error_text_set(error, NO_SUCH_NAME, scenario->settings->params.scenario, from->line,
                              index, "shooter", from->shooter);
    if (name_index_find(names, from->target, &order->target_slot) != 0)
        return error_text_set(error, NO_SUCH_NAME, scenario->settings->params.scenario, from->line,
                              index, "target", from->target);
    if (order->shooter_slot == SLOT_NONE && scenario->kinds[order->kind].delivery == DELIVERY_ARC)
        begin_approach(order, scenario->settings->params.hz);
    return 0;
}

static int build_fires(struct world_build *built, const struct name_index *name_index,
                       struct error_text *error)
{
    uint32_t count = built->scenario->fire_count;
    built->fires = calloc(count + 1, sizeof *built->fires);
    if (!built->fires)
        return error_text_memory(error);
    for (uint32_t i = 0; i < count; i++) {
        if (build_fire(built, i, name_index, error) != 0)
            return -1;
    }
    qsort(built->fires, count, sizeof *built->fires, by_tick);
    built->counts.fires = count;
    return 0;
}

/* Builds the parts that refer to vehicles by name: ordered shots, and scripts. */
static int build_orders(struct world_build *built, struct error_text *error)
{
    struct name_index name_index;
    if (name_index_init(&name_index, built->names, built->used) != 0)
        return error_text_memory(error);
    int result = script_build_build(built, &name_index, error);
    if (result == 0)
        result = build_fires(built, &name_index, error);
    if (result == 0)
        result = mission_build_build(built, error);
    name_index_free(&name_index);
    return result;
}

struct terrain world_build_terrain(const struct world_build *built)
{
    const struct gridsquares squares = gridsquares_of(built->counts.side_m);
    return (struct terrain){
        .posts = built->counts.posts_in_file ? built->posts_file.posts : built->posts,
        .cover = built->counts.posts_in_file ? built->posts_file.cover : built->cover,
        .side = built->counts.posts_side,
        .spacing_m = built->counts.side_m / (double)(built->counts.posts_side - 1),
        .earthworks = {built->scenario->earthworks, built->earthwork_index,
                       built->counts.earthworks, squares},
        .squares = squares};
}

int world_build_make(struct world_build *built, const struct scenario *scenario,
                     struct error_text *error)
{
    *built = (struct world_build){.scenario = scenario};
    built->counts = (struct counts){
        .kinds = scenario->kind_count,
        .models = scenario->model_count,
        .model_vertices = scenario->vertex_count,
        .model_triangles = scenario->triangle_count,
        .hulls = scenario->hull_count,
        .hull_vertices = scenario->hull_vertex_count,
        .hull_planes = scenario->hull_plane_count,
        .areas = scenario->area_count,
        .objectives = scenario->objective_count,
        .recipe = provenance_room(scenario->recipe.bytes),
        .side_m = (uint32_t)scenario->settings->side_m,
    };
    if (build_ground(built, error) != 0 || build_earthworks(built, error) != 0 ||
        build_objects(built, error) != 0 || road_routing_build(built, error) != 0 ||
        vehicle_placement_build(built, error) != 0 || build_orders(built, error) != 0) {
        world_build_free(built);
        return -1;
    }
    return 0;
}

void world_build_free(struct world_build *built)
{
    free(built->posts);
    free(built->cover);
    posts_file_close(&built->posts_file);
    free(built->earthwork_index);
    free(built->fixed);
    free(built->reach_start);
    free(built->reach);
    free(built->roads);
    free(built->fires);
    free(built->routes);
    free(built->route_points);
    free(built->formations);
    free(built->scripts);
    free(built->steps);
    free(built->missions);
    free(built->phases);
    free(built->members);
    free(built->names);
    free(built->first_memory);
    *built = (struct world_build){0};
}
