/* The verbs' arguments. */
#include "worldctl/arguments.h"

#include "ipc/log.h"
#include "ipc/process.h"

#include <errno.h>
#include <getopt.h>
#include <string.h>

static void add_set(struct arguments *arguments, const char *text)
{
    if (!strchr(text, '='))
        die_usage("--set %s: must be KEY=VALUE, for example --set world.seed=7", text);
    if (arguments->sets == ARGUMENT_SETS_MAX)
        die_usage("--set: more than %d of them; put them into a scenario file", ARGUMENT_SETS_MAX);
    arguments->set[arguments->sets++] = text;
}

static const struct option known[] = {{"world", required_argument, NULL, 'w'},
                                      {"terrain", required_argument, NULL, 't'},
                                      {"log", required_argument, NULL, 'l'},
                                      {"set", required_argument, NULL, 's'},
                                      {"from", required_argument, NULL, 'F'},
                                      {"hang-ms", required_argument, NULL, 'H'},
                                      {"wall", required_argument, NULL, 'W'},
                                      {"parent", required_argument, NULL, 'p'},
                                      {"pid", required_argument, NULL, 'i'},
                                      {"seconds", required_argument, NULL, 'S'},
                                      {"json", no_argument, NULL, 'j'},
                                      {"follow", no_argument, NULL, 'f'},
                                      {"fixed", no_argument, NULL, 'x'},
                                      {"force", no_argument, NULL, '!'},
                                      {"progress", no_argument, NULL, 'P'},
                                      {"adopt", no_argument, NULL, 'a'},
                                      {NULL, 0, NULL, 0}};

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
    case 'P':
        return arguments->progress = true;
    case 'a':
        return arguments->adopt = true;
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
    case 'l':
        arguments->log = value;
        break;
    case 's':
        add_set(arguments, value);
        break;
    case 'F':
        arguments->from_frame = process_whole("from", value, 0, UINT64_MAX);
        break;
    case 'H':
        arguments->hang_ms = process_whole("hang-ms", value, 20, 3600000);
        break;
    case 'W':
        arguments->wall_s = process_number("wall", value, 0, 1e12);
        break;
    case 'p':
        arguments->parent = (int)process_whole("parent", value, 1, INT32_MAX);
        break;
    case 'i':
        arguments->pid = (int)process_whole("pid", value, 1, INT32_MAX);
        break;
    default:
        arguments->seconds = process_number("seconds", value, 0.001, 1e9);
        break;
    }
}

struct arguments arguments_read(int argc, char **argv)
{
    struct arguments arguments = {.world = "default", .hang_ms = 100};
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
    if (optind < argc)
        die_usage("%s: one argument too many; try jolon-world help", argv[optind]);
    return arguments;
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
            die_refused("world \"%s\" is damaged: its last frame fails its checksum",
                        arguments->world);
        if (tries == 1000)
            die_refused("world \"%s\" goes on faster than it can be copied; pause it with `jolon "
                        "ctl pause`",
                        arguments->world);
    }
}
