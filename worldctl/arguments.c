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

struct arguments arguments_read(int argc, char **argv)
{
    static const struct option options[] = {{"world", required_argument, NULL, 'w'},
                                            {"json", no_argument, NULL, 'j'},
                                            {"follow", no_argument, NULL, 'f'},
                                            {"from", required_argument, NULL, 'F'},
                                            {"fixed", no_argument, NULL, 'x'},
                                            {"terrain", required_argument, NULL, 't'},
                                            {"log", required_argument, NULL, 'l'},
                                            {"force", no_argument, NULL, '!'},
                                            {"progress", no_argument, NULL, 'P'},
                                            {"hang-ms", required_argument, NULL, 'H'},
                                            {"wall", required_argument, NULL, 'W'},
                                            {"parent", required_argument, NULL, 'p'},
                                            {"set", required_argument, NULL, 's'},
                                            {"seconds", required_argument, NULL, 'S'},
                                            {"pid", required_argument, NULL, 'i'},
                                            {"adopt", no_argument, NULL, 'a'},
                                            {NULL, 0, NULL, 0}};
    struct arguments arguments = {.world = "default", .hang_ms = 100};
    int option;
    opterr = 0; /* we say it, in one line */
    while ((option = getopt_long(argc, argv, "w:", options, NULL)) != -1) {
        switch (option) {
        case 'w':
            arguments.world = optarg;
            break;
        case 'j':
            arguments.json = true;
            break;
        case 'f':
            arguments.follow = true;
            break;
        case 'F':
            arguments.from_frame = process_whole("from", optarg, 0, UINT64_MAX);
            break;
        case 'x':
            arguments.fixed = true;
            break;
        case 't':
            arguments.terrain = optarg;
            break;
        case 'l':
            arguments.log = optarg;
            break;
        case '!':
            arguments.force = true;
            break;
        case 'P':
            arguments.progress = true;
            break;
        case 'H':
            arguments.hang_ms = process_whole("hang-ms", optarg, 20, 3600000);
            break;
        case 'W':
            arguments.wall_s = process_number("wall", optarg, 0, 1e12);
            break;
        case 'p':
            arguments.parent = (int)process_whole("parent", optarg, 1, INT32_MAX);
            break;
        case 'i':
            arguments.pid = (int)process_whole("pid", optarg, 1, INT32_MAX);
            break;
        case 'a':
            arguments.adopt = true;
            break;
        case 'S':
            arguments.seconds = process_number("seconds", optarg, 0.001, 1e9);
            break;
        case 's':
            add_set(&arguments, optarg);
            break;
        default:
            die_usage("%s: no such option, or its value is missing; try jolon-world help",
                      argv[optind - 1]);
        }
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
