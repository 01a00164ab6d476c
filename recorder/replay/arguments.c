/* The verbs' arguments. */
#include "recorder/replay/arguments.h"

#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/segment/segment_attach.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/runtime/thread_pool.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void arguments_set(struct arguments *arguments, const char *text)
{
    if (!strchr(text, '='))
        die_usage("--set %s: must be KEY=VALUE, for example --set world.seed=7", text);
    if (arguments->sets == ARGUMENT_SETS_MAX)
        die_usage("--set: more than %d of them; put them into a scenario file", ARGUMENT_SETS_MAX);
    arguments->set[arguments->sets++] = text;
}

static struct arguments given = {.world = "default", .threads = 1};

static int take_set(const char *text, struct error_text *detail)
{
    (void)detail;
    arguments_set(&given, text);
    return 0;
}

static const struct option_row rows[] = {
    {"world", "NAME", NULL, .text = &given.world, .letter = 'w'},
    {"terrain", "X0,Z0,X1,Z1,STEP", NULL, .text = &given.terrain},
    {"events", "FILE", NULL, .text = &given.events},
    {"frames", "N", NULL, .u64 = &given.frames, .least = 1, .most = UINT64_MAX},
    {"threads", "N", NULL, .u32 = &given.threads, .least = 1, .most = THREAD_POOL_MAX},
    {"set", "KEY=VALUE", NULL, .take = take_set},
    {"from", "FROM", NULL, .text = &given.from},
    {"wall", "SECONDS", NULL, .real = &given.wall_s, .high = 1e12},
    {"seconds", "S", NULL, .real = &given.seconds, .low = 0.001, .high = 1e9},
    {"json", NULL, NULL, .flag = &given.json},
    {"follow", NULL, NULL, .flag = &given.follow},
    {"fixed", NULL, NULL, .flag = &given.fixed},
    {"force", NULL, NULL, .flag = &given.force},
    {"adopt", NULL, NULL, .flag = &given.adopt},
    {"inputs", NULL, NULL, .flag = &given.inputs},
    {"physics", NULL, NULL, .flag = &given.physics},
    OPTION_ROWS_END};

int arguments_verb(int argc, char **argv)
{
    static const struct option_table table = {.rows = rows};
    return option_table_verb(&table, argc, argv);
}

struct arguments arguments_read(int argc, char **argv, const char *verb, const char *usage,
                                int plain_max)
{
    char program[64];
    (void)snprintf(program, sizeof program, "jolon-world %s", verb);
    const struct option_table table = {
        .program = program, .usage = usage, .rows = rows, .usage_rows = true, .plain = plain_max};
    int plain = option_table_read(&table, argc, argv);
    if (plain > 0)
        given.path = argv[argc - plain];
    if (plain > 1)
        given.other = argv[argc - 1];
    return given;
}

void arguments_seconds(const struct arguments *arguments, struct params *params)
{
    uint64_t limit = (uint64_t)ceil(arguments->seconds * params->hz - 1e-6);
    if (arguments->seconds <= 0.0 || limit == params->frame_limit)
        return;
    params->frame_limit = limit;
    params->scenario_hash ^= random_mix(limit);
}

void arguments_attach(const struct arguments *arguments, struct view *view)
{
    struct error_text error;
    if (segment_attach(view, arguments->world, ROLE_NONE, &error) != 0)
        die_refused("%s", error.text);
}

void arguments_snapshot(const struct arguments *arguments, struct view *view,
                        struct snapshot *snapshot)
{
    arguments_attach(arguments, view);
    if (snapshot_init(snapshot, view) != 0)
        die_refused("out of memory for a copy of the world");
    for (int tries = 0; snapshot_take(snapshot, view) != 0; tries++) {
        if (errno == EBADMSG)
            die_refused("world \"%s\" is damaged: its last frame fails its checksum; `jolon world "
                        "repair` can go back to the one before",
                        arguments->world);
        if (tries == 1000)
            die_refused("world \"%s\" goes on faster than it can be copied; pause it with `jolon "
                        "ctl pause`",
                        arguments->world);
    }
}
