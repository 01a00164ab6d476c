/* Making a world to measure on. */
#include "bench/world.h"

#include "config/loader.h"
#include "ipc/log.h"
#include "ipc/process.h"

#include <stdio.h>
#include <stdlib.h>

/* What patrols when another number than the scenario's is asked for: parts of a hundred. */
static const struct {
    const char *kind;
    uint32_t share;
} mixture[] = {{"tank", 50}, {"truck", 20}, {"jeep", 20}, {"helicopter", 10}};

#define KINDS (sizeof mixture / sizeof mixture[0])

static void replace_groups(struct scenario *scenario, uint32_t vehicles)
{
    struct scenario_group *groups = calloc(KINDS, sizeof *groups);
    struct area *areas = calloc(1, sizeof *areas);
    uint32_t left = vehicles;
    if (!groups || !areas)
        die_refused("out of memory");
    areas[0] = (struct area){0.0, 0.0, 50000.0, 50000.0};
    for (uint32_t i = 0; i < KINDS; i++) {
        uint16_t kind = kind_find(scenario->kinds, scenario->kind_count, mixture[i].kind);
        uint32_t count = i + 1 < KINDS ? vehicles * mixture[i].share / 100 : left;
        if (kind == KIND_NONE)
            die_refused("kind %s is missing", mixture[i].kind);
        groups[i] = (struct scenario_group){.kind = kind,
                                            .force = (uint8_t)(i % FORCE_COUNT),
                                            .behaviour = BEHAVIOUR_PATROL,
                                            .count = count,
                                            .route = UINT32_MAX};
        left -= count;
    }
    free(scenario->groups);
    free(scenario->areas);
    scenario->groups = groups;
    scenario->group_count = KINDS;
    scenario->areas = areas;
    scenario->area_count = 1;
    scenario->fire_count = 0;
}

void bench_world_open(struct view *view, const char *path, uint32_t vehicles)
{
    char data_dir[512], capacity[64], text[512];
    const char *const overrides[] = {capacity};
    struct scenario scenario;
    struct genesis genesis;
    struct loader_message message;
    struct reason reason;
    uint32_t room = vehicles + vehicles / 4 + 4096;
    snprintf(capacity, sizeof capacity, "world.capacity=%u",
             room < CAPACITY_MAX ? room : CAPACITY_MAX);
    if (process_data_dir(data_dir, sizeof data_dir) != 0)
        die_refused("cannot find the data; set JOLON_DATA");
    if (loader_scenario(&scenario, data_dir, path, overrides, 1, &message) != 0)
        die_refused("%s", message.text);
    if (vehicles != BENCH_SCENARIO_VEHICLES)
        replace_groups(&scenario, vehicles);
    if (genesis_build(&genesis, &scenario, text, sizeof text) != 0)
        die_refused("%s", text);
    struct segment_header header = segment_header_for(&scenario.params, &genesis.counts);
    if (segment_private(view, &header, &reason) != 0)
        die_refused("%s", reason.text);
    segment_fill(view, &genesis);
    genesis_free(&genesis);
    scenario_free(&scenario);
}
