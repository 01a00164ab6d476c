/* The verbs' arguments. */
#include "worldctl/arguments.h"

#include "ipc/log.h"
#include "ipc/process.h"
#include "world/random.h"
#include "world/workers.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <string.h>

void arguments_set(struct arguments *arguments, const char *text)
{
    if (!strchr(text, '='))
        die_usage("--set %s: must be KEY=VALUE, for example --set world.seed=7", text);
    if (arguments->sets == ARGUMENT_SETS_MAX)
        die_usage("--set: more than %d of them; put them into a scenario file", ARGUMENT_SETS_MAX);
    arguments->set[arguments->sets++] = text;
}

static const struct option known[] = {
    {"world", required_argument, NULL, 'w'},   {"terrain", required_argument, NULL, 't'},
    {"events", required_argument, NULL, 'e'},  {"frames", required_argument, NULL, 'n'},
    {"threads", required_argument, NULL, 'T'}, {"set", required_argument, NULL, 's'},
    {"from", required_argument, NULL, 'F'},    {"wall", required_argument, NULL, 'W'},
    {"seconds", required_argument, NULL, 'S'}, {"json", no_argument, NULL, 'j'},
    {"follow", no_argument, NULL, 'f'},        {"fixed", no_argument, NULL, 'x'},
    {"force", no_argument, NULL, '!'},         {"adopt", no_argument, NULL, 'a'},
    {"inputs", no_argument, NULL, 'I'},        {NULL, 0, NULL, 0}};

/* Options without a value; false for any other. */
static bool take_flag(struct arguments *arguments, int option)
{
    switch (option) {
    case 'j':
        return arguments->json = true;
    case 'f':
        return arguments->follow = true;
    case 'x':
        return arguments->fixed = true;
    case '!':
        return arguments->force = true;
    case 'a':
        return arguments->adopt = true;
    case 'I':
        return arguments->inputs = true;
    default:
        return false;
    }
}

static void take_value(struct arguments *arguments, int option, const char *value)
{
    switch (option) {
    case 'w':
        arguments->world = value;
        break;
    case 't':
        arguments->terrain = value;
        break;
    case 'e':
        arguments->events = value;
        break;
    case 'n':
        arguments->frames = process_whole("frames", value, 1, UINT64_MAX);
        break;
    case 'T':
        arguments->threads = (uint32_t)process_whole("threads", value, 1, WORKERS_MAX);
        break;
    case 's':
        arguments_set(arguments, value);
        break;
    case 'F':
        arguments->from = value;
        break;
    case 'W':
        arguments->wall_s = process_number("wall", value, 0, 1e12);
        break;
    default:
        arguments->seconds = process_number("seconds", value, 0.001, 1e9);
        break;
    }
}

static struct arguments read_plain(int argc, char **argv, bool two)
{
    struct arguments arguments = {.world = "default", .threads = 1};
    int option;
    opterr = 0; /* we say it, in one line */
    while ((option = getopt_long(argc, argv, "w:", known, NULL)) != -1) {
        if (option == '?' || option == ':')
            die_usage("%s: no such option, or its value is missing; try jolon-world help",
                      argv[optind - 1]);
        if (!take_flag(&arguments, option))
            take_value(&arguments, option, optarg);
    }
    if (optind < argc)
        arguments.path = argv[optind++];
    if (two && optind < argc)
        arguments.other = argv[optind++];
    if (optind < argc)
        die_usage("%s: one argument too many; try jolon-world help", argv[optind]);
    if (two && !arguments.other)
        die_usage("%s: wants two arguments; try jolon-world help", argv[0]);
    return arguments;
}

struct arguments arguments_read(int argc, char **argv)
{
    return read_plain(argc, argv, false);
}

struct arguments arguments_read_two(int argc, char **argv)
{
    return read_plain(argc, argv, true);
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
    struct reason reason;
    if (segment_attach(view, arguments->world, ROLE_NONE, &reason) != 0)
        die_refused("%s", reason.text);
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
