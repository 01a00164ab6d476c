/* Makes worlds to measure on. */
#include "tests/bench/world.h"

#include "config/loader.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/maths/maths.h"
#include "world/terrain/gridsquare.h"

#include <stdio.h>
#include <stdlib.h>

/* The kinds on patrol when another number of vehicles is requested, in percent. */
struct share {
    const char *kind;
    uint32_t percent;
    enum force force;
    uint8_t flags; /* ENTITY_FLAG_* */
};

#define KINDS   8
#define NEVER_J 1e12 /* no impact has so much energy */

#define DENSE_SQUARE_M 800.0 /* [m2] for each vehicle of BENCH_MODE_DENSE */

static const struct share mixture[KINDS] = {{"tank", 50, FORCE_NEUTRAL, 0},
                                            {"truck", 20, FORCE_BLUE, 0},
                                            {"jeep", 20, FORCE_RED, 0},
                                            {"helicopter", 10, FORCE_NEUTRAL, 0}};

/* Two forces that attack the enemies that they see. */
#define AT_WILL ENTITY_FLAG_FIRE_AT_WILL
static const struct share agents[KINDS] = {
    {"tank", 25, FORCE_BLUE, AT_WILL},      {"tank", 25, FORCE_RED, AT_WILL},
    {"carrier", 10, FORCE_BLUE, AT_WILL},   {"carrier", 10, FORCE_RED, AT_WILL},
    {"jeep", 10, FORCE_BLUE, AT_WILL},      {"jeep", 10, FORCE_RED, AT_WILL},
    {"helicopter", 5, FORCE_BLUE, AT_WILL}, {"helicopter", 5, FORCE_RED, AT_WILL}};

/* What replaces the groups of a scenario. */
struct crowd {
    const struct share *shares; /* [KINDS] NULL: the scenario's own groups stay */
    uint8_t behaviour;
    double side_m; /* of the square in the middle of the map that the vehicles are in */
};

static void replace_groups(struct scenario *scenario, uint32_t vehicles, const struct crowd *crowd)
{
    const struct share *shares = crowd->shares;
    double low = BENCH_MIDDLE_M - 0.5 * crowd->side_m, high = BENCH_MIDDLE_M + 0.5 * crowd->side_m;
    struct scenario_group *groups = calloc(KINDS, sizeof *groups);
    struct area *areas = calloc(1, sizeof *areas);
    uint32_t left = vehicles;
    if (!groups || !areas)
        die_refused("out of memory");
    areas[0] = (struct area){low, low, high, high};
    uint32_t used = 0;
    for (; used < KINDS && shares[used].kind; used++) {
        const struct share *share = &shares[used];
        uint16_t kind = kind_find(scenario->kinds, scenario->kind_count, share->kind);
        bool last = used + 1 == KINDS || !shares[used + 1].kind;
        uint32_t count = last ? left : vehicles * share->percent / 100;
        if (kind == KIND_NONE)
            die_refused("kind %s is missing", share->kind);
        groups[used] = (struct scenario_group){.kind = kind,
                                               .force = (uint8_t)share->force,
                                               .behaviour = crowd->behaviour,
                                               .flags = share->flags,
                                               .count = count,
                                               .route = UINT32_MAX};
        left -= count;
    }
    free(scenario->groups);
    free(scenario->areas);
    scenario->groups = groups;
    scenario->group_count = used;
    scenario->areas = areas;
    scenario->area_count = 1;
    scenario->fire_count = 0;
}

#define OVERRIDES_MAX 8

/* vehicles: for which the world needs room besides munitions; 0: the scenario says its capacity,
 * by which agents take turns. overrides: room for OVERRIDES_MAX, of which count are set. */
static void read_scenario(struct scenario *scenario, const char *path, uint32_t vehicles,
                          const char **overrides, int count)
{
    char data_dir[512], capacity[64];
    struct error_text error;
    uint32_t room = vehicles + vehicles / 4 + 4096;
    snprintf(capacity, sizeof capacity, "world.capacity=%u",
             room < CAPACITY_MAX ? room : CAPACITY_MAX);
    if (vehicles > 0)
        overrides[count++] = capacity;
    if (process_data_dir(data_dir, sizeof data_dir) != 0)
        die_refused("cannot find the data; set JOLON_DATA");
    if (loader_scenario(scenario, data_dir, path, overrides, count, &error) != 0)
        die_refused("%s", error.text);
}

/* Frees the scenario. */
static void build(struct view *view, struct scenario *scenario)
{
    struct error_text error;
    struct world_build built;
    if (world_build_make(&built, scenario, &error) != 0)
        die_refused("%s", error.text);
    struct segment_header header = segment_header_for(&scenario->settings->params, &built.counts);
    if (segment_private(view, &header, &error) != 0)
        die_refused("%s", error.text);
    segment_fill(view, &built);
    world_build_free(&built);
    scenario_free(scenario);
}

static void open_world(struct view *view, const char *path, uint32_t vehicles, uint32_t more,
                       const struct crowd *crowd)
{
    const char *overrides[OVERRIDES_MAX];
    struct scenario scenario;
    bool own = !crowd->shares && more == 0;
    read_scenario(&scenario, path, own ? 0 : vehicles + more, overrides, 0);
    if (crowd->shares)
        replace_groups(&scenario, vehicles, crowd);
    build(view, &scenario);
}

/* Vehicles on patrol all over the map, or the scenario's own. */
static struct crowd usual(uint32_t vehicles)
{
    return (struct crowd){.shares = vehicles != BENCH_SCENARIO_VEHICLES ? mixture : NULL,
                          .behaviour = BEHAVIOUR_PATROL,
                          .side_m = WORLD_SIDE_DEFAULT_M};
}

void bench_world_open(struct view *view, const char *path, uint32_t vehicles)
{
    const struct crowd crowd = usual(vehicles);
    open_world(view, path, vehicles, 0, &crowd);
}

void bench_world_mode(struct view *view, enum bench_mode mode, uint32_t vehicles, uint32_t more)
{
    struct crowd crowd = usual(vehicles);
    if (mode != BENCH_MODE_SCENARIO)
        crowd.shares = mode == BENCH_MODE_WAR ? agents : mixture;
    if (mode == BENCH_MODE_IDLE)
        crowd.behaviour = BEHAVIOUR_IDLE;
    if (mode == BENCH_MODE_DENSE)
        crowd.side_m = maths_min(WORLD_SIDE_DEFAULT_M, sqrt(DENSE_SQUARE_M * (double)vehicles));
    open_world(view, NULL, vehicles, more, &crowd);
}

void bench_world_tanks(struct view *view, const struct heap_tanks *tanks)
{
    const char *overrides[OVERRIDES_MAX] = {"terrain.source=flat", "collision.shape=model"};
    struct scenario scenario;
    struct scenario_group *groups = calloc(tanks->count, sizeof *groups);
    read_scenario(&scenario, NULL, tanks->count, overrides, 2);
    uint16_t kind = kind_find(scenario.kinds, scenario.kind_count, "tank");
    if (!groups || kind == KIND_NONE)
        die_refused(groups ? "kind tank is missing" : "out of memory");
    scenario.kinds[kind].resistance_j = NEVER_J;
    for (uint32_t i = 0; i < tanks->count; i++) {
        const struct heap_place *place = &tanks->place[i];
        groups[i] = (struct scenario_group){.kind = kind,
                                            .behaviour = BEHAVIOUR_HOLD,
                                            .placed = 1,
                                            .turned = 1,
                                            .moving = 1,
                                            .count = 1,
                                            .route = UINT32_MAX,
                                            .script = UINT32_MAX,
                                            .x = BENCH_MIDDLE_M + place->x,
                                            .z = BENCH_MIDDLE_M + place->z,
                                            .heading_rad =
                                                maths_heading(place->forward_x, place->forward_z),
                                            .speed_mps = HEAP_SPEED_MPS};
    }
    free(scenario.groups);
    scenario.groups = groups;
    scenario.group_count = tanks->count;
    scenario.fire_count = 0;
    build(view, &scenario);
}
