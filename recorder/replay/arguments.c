/* The verbs' arguments. */
#include "recorder/replay/arguments.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "world/maths/random.h"
#include "world/runtime/thread_pool.h"

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

static const struct option known[] = {{"world", required_argument, NULL, 'w'},
                                      {"terrain", required_argument, NULL, 't'},
                                      {"events", required_argument, NULL, 'e'},
                                      {"frames", required_argument, NULL, 'n'},
                                      {"threads", required_argument, NULL, 'T'},
                                      {"set", required_argument, NULL, 's'},
                                      {"from", required_argument, NULL, 'F'},
                                      {"wall", required_argument, NULL, 'W'},
                                      {"seconds", required_argument, NULL, 'S'},
                                      {"json", no_argument, NULL, 'j'},
                                      {"follow", no_argument, NULL, 'f'},
                                      {"fixed", no_argument, NULL, 'x'},
                                      {"force", no_argument, NULL, '!'},
                                      {"adopt", no_argument, NULL, 'a'},
                                      {"inputs", no_argument, NULL, 'I'},
                                      {"help", no_argument, NULL, 'h'},
                                      {NULL, 0, NULL, 0}};

static const char *option_name(int letter)
{
    const struct option *option = known;
    while (option->val != letter)
        option++;
    return option->name;
}

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
        arguments->threads = (uint32_t)process_whole("threads", value, 1, THREAD_POOL_MAX);
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

/* Ends the process when the verb does not take that option. */
static void check_option(const char *verb, const char *name, const struct accepted *accepted)
{
    size_t length = strlen(name);
    for (const char *at = accepted->options; *at != '\0'; at = strchr(at, ' ') + 1) {
        if (strncmp(at, name, length) == 0 && at[length] == ' ')
            return;
    }
    die_usage("%s: does not take --%s; try jolon-world %s --help", verb, name, verb);
}

static void take_plain(struct arguments *arguments, int count, char **plain, const char *verb,
                       const struct accepted *accepted)
{
    if (count > accepted->plain)
        die_usage("%s: \"%s\" is one argument too many; try jolon-world %s --help", verb,
                  plain[accepted->plain], verb);
    if (count > 0)
        arguments->path = plain[0];
    if (count > 1)
        arguments->other = plain[1];
}

struct arguments arguments_read(int argc, char **argv, const struct accepted *accepted)
{
    struct arguments arguments = {.world = "default", .threads = 1};
    int option;
    opterr = 0; /* we say it, in one line */
    while ((option = getopt_long(argc, argv, "w:h", known, NULL)) != -1) {
        if (option == '?' || option == ':')
            die_usage("%s: no such option, or its value is missing; try jolon-world %s --help",
                      argv[optind - 1], argv[0]);
        if (option == 'h') {
            arguments.help = true;
            return arguments;
        }
        check_option(argv[0], option_name(option), accepted);
        if (!take_flag(&arguments, option))
            take_value(&arguments, option, optarg);
    }
    take_plain(&arguments, argc - optind, argv + optind, argv[0], accepted);
    return arguments;
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
