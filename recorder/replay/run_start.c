/* Makes the start of a recorded run again. */
#include "recorder/replay/run_start.h"

#include "ipc/segment/segment_check.h"
#include "recorder/archive/image_read.h"
#include "ipc/process/log.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/provenance.h"
#include "world/runtime/parse_number.h"
#include "recorder/replay/scenario_load.h"
#include "recorder/replay/image_resume.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

void run_start_open(struct log_replay *replay, const char *path)
{
    struct error_text error;
    if (log_replay_open(replay, path, &error) != 0)
        die_refused("%s", error.text);
    if (replay->torn)
        log_warn("%s: its last line is torn: left out", path);
}

/* Computes the arguments that correspond to the log's provenance. */
static void arguments_of(struct arguments *arguments, const struct log_replay *replay)
{
    const cJSON *text;
    *arguments = (struct arguments){.world = "default",
                                    .path = log_replay_provenance(replay, "scenario"),
                                    .from = log_replay_provenance(replay, "image")};
    const char *seconds = log_replay_provenance(replay, "seconds");
    if (seconds && !parse_real(seconds, 0.001, 1e9, &arguments->seconds))
        die_refused("%s:1: provenance: seconds=%s: must be a number from 0.001 to 1e9",
                    replay->path, seconds);
    cJSON_ArrayForEach(text, cJSON_GetObjectItemCaseSensitive(replay->begin, "recipe"))
    {
        const char *set = cJSON_IsString(text) ? provenance_value(text->valuestring, "set") : NULL;
        if (!set)
            continue;
        if (!strchr(set, '='))
            die_refused("%s:1: provenance: set=%s: must be set=KEY=VALUE", replay->path, set);
        if (arguments->sets == ARGUMENT_SETS_MAX)
            die_refused("%s:1: provenance: more than %d texts set=KEY=VALUE", replay->path,
                        ARGUMENT_SETS_MAX);
        arguments_set(arguments, set);
    }
}

static const char *scenario_text(const struct log_replay *replay)
{
    return cJSON_GetObjectItemCaseSensitive(replay->begin, "scenario")->valuestring;
}

/* Overwrites the world's provenance with the log's, byte by byte. */
static void keep_provenance(const struct view *view, const struct log_replay *replay)
{
    const cJSON *text;
    char *to = (char *)(uintptr_t)view->world.recipe;
    uint32_t room = view->world.counts.recipe, used = 0;
    memset(to, 0, room);
    cJSON_ArrayForEach(text, cJSON_GetObjectItemCaseSensitive(replay->begin, "recipe"))
    {
        size_t length = cJSON_IsString(text) ? strlen(text->valuestring) + 1 : room;
        if (length >= room - used)
            die_refused("%s:1: its provenance does not fit into the world that is made from it",
                        replay->path);
        memcpy(to + used, text->valuestring, length);
        used += (uint32_t)length;
    }
}

static void check_hash(const struct log_replay *replay, const struct params *params,
                       const char *from)
{
    if (params->scenario_hash != replay->scenario_hash)
        die_refused("%s: was recorded of another scenario (hash %016" PRIx64 "; now %016" PRIx64
                    "): %s, or one of config/kinds, has changed since",
                    replay->path, replay->scenario_hash, params->scenario_hash, from);
}

/* Names the ground file if that is what has changed. */
static void check_ground(const struct log_replay *replay, const struct scenario *scenario)
{
    const char *was = log_replay_provenance(replay, "ground");
    const char *is = provenance_find(scenario->recipe.text, scenario->recipe.bytes, "ground");
    const int hash = 16; /* digits, before the path */
    if (was && is && strncmp(was, is, (size_t)hash) != 0)
        die_refused("%s: was recorded on the ground %s; %s now has another: its hash is %.*s",
                    replay->path, was, scenario->settings->ground_file, hash, is);
}

static void from_scenario(struct view *view, const struct log_replay *replay,
                          const struct arguments *arguments)
{
    struct scenario scenario;
    struct world_build built;
    struct error_text error;
    scenario_load(arguments, &scenario);
    check_ground(replay, &scenario);
    check_hash(replay, &scenario.settings->params, arguments->path);
    memset(scenario.settings->params.scenario, 0,
           sizeof scenario.settings->params.scenario); /* the static hash covers every byte */
    snprintf(scenario.settings->params.scenario, sizeof scenario.settings->params.scenario, "%s",
             scenario_text(replay));
    scenario_load_generate(&scenario, &built);
    struct segment_header header = segment_header_for(&scenario.settings->params, &built.counts);
    if (segment_private(view, &header, &error) != 0)
        die_refused("%s", error.text);
    segment_fill(view, &built);
    if (segment_map_posts(view, &error) != 0)
        die_refused("%s", error.text);
    world_build_free(&built);
    scenario_free(&scenario);
}

static void from_image(struct view *view, const struct log_replay *replay,
                       const struct arguments *arguments)
{
    static struct image image;
    struct error_text error;
    image_resume_open(arguments, &image);
    if (image.header.header_hash != replay->origin)
        die_refused("%s: the run went on from another image than %s is now", replay->path,
                    arguments->from);
    check_hash(replay, &image.params, arguments->from);
    struct segment_header header = image_segment(&image);
    if (segment_private(view, &header, &error) != 0 ||
        image_resume_fill(view, arguments, &image, &error) != 0)
        die_refused("%s", error.text);
    image_close(&image);
}

void run_start_make(struct view *view, const struct log_replay *replay)
{
    struct arguments arguments;
    if (replay->layout != layout_hash())
        die_refused("%s: layout: was recorded by another build of Jolon; replay it with that build",
                    replay->path);
    arguments_of(&arguments, replay);
    if (arguments.from)
        from_image(view, replay, &arguments);
    else if (arguments.path)
        from_scenario(view, replay, &arguments);
    else
        die_refused("%s:1: names neither a scenario nor an image that the world was made from",
                    replay->path);
    keep_provenance(view, replay);
    segment_hash_static(view);
    if (segment_static_hash(view->header) != replay->static_hash)
        die_refused("%s: the world made again is not the one that was recorded: %s of it differ",
                    replay->path, "terrain, kinds, models, objects or parameters");
    uint64_t frame = atomic_load(&view->commit->commit);
    if (frame != replay->start.frame)
        die_refused("%s: begins with frame %" PRIu64 "; the world made again is at %" PRIu64,
                    replay->path, replay->start.frame, frame);
}
