/* Verbs create, check and repair. */
#include "ipc/segment/segment_attach.h"
#include "ipc/segment/segment_check.h"
#include "ipc/segment/segment_repair.h"
#include "supervisor/worldctl/verbs.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "recorder/replay/world_adopt.h"
#include "recorder/replay/arguments.h"
#include "recorder/replay/scenario_load.h"
#include "recorder/replay/image_resume.h"

#include <stdio.h>

int verb_create(const struct arguments *arguments)
{
    struct scenario scenario;
    struct world_build built;
    struct view view;
    struct error_text error;
    if (segment_name_check(arguments->world, &error) != 0)
        die_refused("%s", error.text);
    if (arguments->from)
        return image_resume_world(arguments);
    scenario_load(arguments, &scenario);
    if (arguments->adopt && world_adopt(arguments->world, &scenario.settings->params, NULL)) {
        scenario_free(&scenario);
        return EXIT_OK;
    }
    scenario_load_generate(&scenario, &built);
    struct segment_header header = segment_header_for(&scenario.settings->params, &built.counts);
    if (segment_begin(&view, arguments->world, &header, &error) != 0)
        die_refused("%s", error.text);
    segment_fill(&view, &built);
    process_hold_stop();
    if (segment_publish(&view, &error) != 0) {
        segment_abandon(&view);
        die_refused("%s", error.text);
    }
    printf("world \"%s\": %u vehicles, %u fixed objects, %.1f MB\n", arguments->world, built.used,
           built.counts.fixed, (double)view.layout.total / 1e6);
    segment_detach(&view);
    world_build_free(&built);
    scenario_free(&scenario);
    return EXIT_OK;
}

int verb_check(const struct arguments *arguments)
{
    struct view view;
    struct error_text error;
    if (arguments->path || arguments->sets > 0) {
        struct scenario scenario;
        struct world_build built;
        scenario_load(arguments, &scenario);
        scenario_load_generate(&scenario, &built);
        printf("%s: good: %u vehicles, %u fixed objects, seed %llu, hash %016llx\n",
               scenario.settings->params.scenario, built.used, built.counts.fixed,
               (unsigned long long)scenario.settings->params.seed,
               (unsigned long long)scenario.settings->params.scenario_hash);
        world_build_free(&built);
        scenario_free(&scenario);
        return EXIT_OK;
    }
    struct snapshot snapshot;
    arguments_snapshot(arguments, &view, &snapshot);
    if (segment_verify(&view, &error) != 0 ||
        (view.posts_file.mapped && posts_file_verify(&view.posts_file, &error) != 0))
        die_refused("world \"%s\": %s", arguments->world, error.text);
    printf("world \"%s\": good at frame %llu\n", arguments->world,
           (unsigned long long)snapshot.head.frame);
    snapshot_free(&snapshot);
    segment_detach(&view);
    return EXIT_OK;
}

int verb_repair(const struct arguments *arguments)
{
    struct error_text report;
    if (segment_repair(arguments->world, &report) < 0)
        die_refused("%s", report.text);
    printf("%s\n", report.text);
    return EXIT_OK;
}
