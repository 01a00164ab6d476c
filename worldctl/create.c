/* Verbs that make, check and remove worlds. */
#include "worldctl/verbs.h"

#include "config/loader.h"
#include "ipc/log.h"
#include "ipc/process.h"
#include "world/genesis.h"
#include "world/random.h"
#include "worldctl/arguments.h"

#include <math.h>
#include <stdio.h>

/* Reads the scenario, or ends the process with the reason. */
static void load(const struct arguments *arguments, struct scenario *scenario)
{
    char data_dir[512];
    struct loader_message message;
    if (process_data_dir(data_dir, sizeof data_dir) != 0)
        die_refused("cannot find the data (kinds, models, scenarios) beside the programs; set "
                    "JOLON_DATA to the folder that holds kinds/");
    if (loader_scenario(scenario, data_dir, arguments->path, arguments->set, arguments->sets,
                        &message) != 0)
        die_refused("%s", message.text);
    if (arguments->seconds > 0.0) {
        scenario->params.frame_limit =
            (uint64_t)ceil(arguments->seconds * scenario->params.hz - 1e-6);
        scenario->params.scenario_hash ^= random_mix(scenario->params.frame_limit);
    }
}

static void generate(const struct scenario *scenario, struct genesis *genesis)
{
    char text[512];
    if (genesis_build(genesis, scenario, text, sizeof text) != 0)
        die_refused("%s: %s", scenario->params.scenario, text);
}

/* A world that a dead set left behind: goes on when it is this very scenario's, else makes room. */
static bool adopt(const char *name, const struct scenario *scenario)
{
    struct view view;
    struct reason reason;
    bool same = false;
    uint64_t frame = 0;
    if (segment_attach(&view, name, ROLE_NONE, &reason) == 0) {
        same = view.world.params->scenario_hash == scenario->params.scenario_hash;
        frame = atomic_load(&view.commit->commit);
        segment_detach(&view);
    }
    if (same) {
        printf("world \"%s\": a set that died left it at frame %llu; goes on from there\n", name,
               (unsigned long long)frame);
        return true;
    }
    if (segment_remove(name, false, &reason) != 0)
        die_refused("%s", reason.text);
    return false;
}

int verb_create(int argc, char **argv)
{
    struct arguments arguments = arguments_read(argc, argv);
    struct scenario scenario;
    struct genesis genesis;
    struct view view;
    struct reason reason;
    if (!segment_name_ok(arguments.world))
        die_refused("\"%s\" is no name for a world: 1 to %d of a-z A-Z 0-9 _ -", arguments.world,
                    SEGMENT_NAME_MAX - 1);
    load(&arguments, &scenario);
    if (arguments.adopt && adopt(arguments.world, &scenario)) {
        scenario_free(&scenario);
        return EXIT_OK;
    }
    generate(&scenario, &genesis);
    struct segment_header header = segment_header_for(&scenario.params, &genesis.counts);
    if (segment_begin(&view, arguments.world, &header, &reason) != 0)
        die_refused("%s", reason.text);
    segment_fill(&view, &genesis);
    if (segment_publish(&view, &reason) != 0) {
        segment_abandon(&view);
        die_refused("%s", reason.text);
    }
    printf("world \"%s\": %u vehicles, %u fixed objects, %.1f MB\n", arguments.world, genesis.used,
           genesis.counts.fixed, (double)view.layout.total / 1e6);
    segment_detach(&view);
    genesis_free(&genesis);
    scenario_free(&scenario);
    return EXIT_OK;
}

int verb_check(int argc, char **argv)
{
    struct arguments arguments = arguments_read(argc, argv);
    struct view view;
    struct reason reason;
    if (arguments.path || arguments.sets > 0) {
        struct scenario scenario;
        struct genesis genesis;
        load(&arguments, &scenario);
        generate(&scenario, &genesis);
        printf("%s: good: %u vehicles, %u fixed objects, seed %llu, hash %016llx\n",
               scenario.params.scenario, genesis.used, genesis.counts.fixed,
               (unsigned long long)scenario.params.seed,
               (unsigned long long)scenario.params.scenario_hash);
        genesis_free(&genesis);
        scenario_free(&scenario);
        return EXIT_OK;
    }
    struct snapshot snapshot;
    arguments_snapshot(&arguments, &view, &snapshot);
    if (segment_verify(&view, &reason) != 0)
        die_refused("world \"%s\": %s", arguments.world, reason.text);
    printf("world \"%s\": good at frame %llu\n", arguments.world,
           (unsigned long long)snapshot.head.frame);
    snapshot_free(&snapshot);
    segment_detach(&view);
    return EXIT_OK;
}

int verb_list(int argc, char **argv)
{
    char names[256][SEGMENT_NAME_MAX];
    arguments_read(argc, argv);
    int count = segment_list(names, 256);
    for (int i = 0; i < count; i++)
        printf("%s\n", names[i]);
    return EXIT_OK;
}

int verb_remove(int argc, char **argv)
{
    struct arguments arguments = arguments_read(argc, argv);
    struct reason reason;
    if (segment_remove(arguments.world, arguments.force, &reason) != 0)
        die_refused("%s", reason.text);
    return EXIT_OK;
}
