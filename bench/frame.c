/* What the steps of a frame cost: mover and collider one after the other in one process, on the
 * Hunter-Liggett world (500 vehicles), or on its ground with any number of vehicles on patrol. */
#include "bench/bench.h"

#include "config/loader.h"
#include "ipc/clock.h"
#include "ipc/log.h"
#include "ipc/process.h"
#include "ipc/segment.h"
#include "replay/player.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SCENARIO_VEHICLES 500

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

static void make_world(struct view *view, uint32_t vehicles)
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
    if (loader_scenario(&scenario, data_dir, NULL, overrides, 1, &message) != 0)
        die_refused("%s", message.text);
    if (vehicles != SCENARIO_VEHICLES)
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

struct times {
    double *mover_ms, *collider_ms, *frame_ms;
};

static void run(struct view *view, const struct bench_options *options, struct times *times)
{
    struct player player;
    if (player_init(&player, view, options->threads) != 0)
        die_refused("cannot begin: %s", strerror(errno));
    for (uint32_t i = 0; i < options->frames; i++) {
        uint64_t t0 = clock_now_ns();
        if (player_move(&player, NULL) != 0)
            die_refused("out of memory");
        uint64_t t1 = clock_now_ns();
        if (player_collide(&player) != 0)
            die_refused("out of memory");
        uint64_t t2 = clock_now_ns();
        times->mover_ms[i] = (double)(t1 - t0) / 1e6;
        times->collider_ms[i] = (double)(t2 - t1) / 1e6;
        times->frame_ms[i] = (double)(t2 - t0) / 1e6;
    }
    player_free(&player);
}

int bench_frame(int argc, char **argv)
{
    struct bench_options options = bench_options(
        argc, argv, (struct bench_options){.vehicles = 500, .threads = 1, .frames = 1200});
    struct view view;
    make_world(&view, options.vehicles);
    double *values = calloc((size_t)options.frames * 3, sizeof *values);
    if (!values)
        die_refused("out of memory");
    struct times times = {values, values + options.frames, values + 2 * (size_t)options.frames};
    run(&view, &options, &times);
    const struct state_head *head = view.w[options.frames & 1].head;
    double mover = bench_quantile(times.mover_ms, options.frames, 0.5);
    double collider = bench_quantile(times.collider_ms, options.frames, 0.5);
    double frame = bench_quantile(times.frame_ms, options.frames, 0.5);
    double slow = bench_quantile(times.frame_ms, options.frames, 0.99);
    if (options.json)
        printf(
            "{\"vehicles\":%u,\"threads\":%u,\"frames\":%u,\"mover_ms\":%.6f,\"collider_ms\":%.6f,"
            "\"frame_ms\":%.6f,\"frame_p99_ms\":%.6f,\"collisions\":%llu}\n",
            options.vehicles, options.threads, options.frames, mover, collider, frame, slow,
            (unsigned long long)head->tally.collisions);
    else
        printf(
            "%u vehicles, %u thread(s), %u frames: mover %.3f ms, collider %.3f ms, frame %.3f ms "
            "(p99 %.3f); %llu collisions\n",
            options.vehicles, options.threads, options.frames, mover, collider, frame, slow,
            (unsigned long long)head->tally.collisions);
    free(values);
    segment_abandon(&view);
    return EXIT_OK;
}
