/* jolon-world: makes, checks, repairs, describes, dumps, saves and removes worlds; replays recorded
 * runs and compares worlds. The only program that reads configuration. */
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "recorder/replay/arguments.h"
#include "supervisor/worldctl/verbs.h"

#include <stdio.h>
#include <string.h>

struct verb {
    const char *name;
    int (*run)(const struct arguments *arguments);
    struct accepted accepted;
    const char *usage;
};

static const struct verb verbs[] = {
    {"create",
     verb_create,
     {"world seconds adopt set from ", 1},
     "[--world NAME] [--seconds S] [--adopt] [--set KEY=VALUE]... [SCENARIO | --from FILE]     "
     "make a world, or go on from an image"},
    {"check",
     verb_check,
     {"world set ", 1},
     "[--world NAME | [--set KEY=VALUE]... SCENARIO]     check a world's memory, or a scenario"},
    {"repair",
     verb_repair,
     {"world ", 0},
     "[--world NAME]     go back to a damaged world's newest whole frame, while nobody runs it"},
    {"info",
     verb_info,
     {"world json ", 0},
     "[--world NAME] [--json]     what the world is made of"},
    {"status",
     verb_status,
     {"world json ", 0},
     "[--world NAME] [--json]     who runs it and how far it is"},
    {"summary",
     verb_summary,
     {"world json wall ", 0},
     "[--world NAME] [--json] [--wall SECONDS]     what happened"},
    {"digest",
     verb_digest,
     {"world json ", 0},
     "[--world NAME] [--json]     digests of the last committed frame"},
    {"dump",
     verb_dump,
     {"world json fixed terrain ", 0},
     "[--world NAME] [--json] [--fixed | --terrain X0,Z0,X1,Z1,STEP]     every entity"},
    {"events",
     verb_events,
     {"world follow from json ", 0},
     "[--world NAME] [--follow] [--from FRAME] [--json]     what happened, in order"},
    {"replay",
     verb_replay,
     {"frames json events threads ", 1},
     "[--frames N] [--json] [--events FILE] [--threads N] LOG     run a log of commands again"},
    {"diff",
     verb_diff,
     {"json threads ", 2},
     "[--json] [--threads N] A B     first difference of two logs of commands, images, worlds"},
    {"list",
     verb_list,
     {"", 1},
     "[worlds | all | lost]     this user's worlds; all: what is left of dead ones too; lost: "
     "files in /dev/shm that no name leads to"},
    {"paths",
     verb_paths,
     {"world ", 1},
     "[--world NAME] [name | lock | object]     where the world is in the file system"},
    {"remove",
     verb_remove,
     {"world force ", 0},
     "[--world NAME] [--force]     free a world's shared memory"},
    {"sweep",
     verb_sweep,
     {"world ", 0},
     "[--world NAME]     remove what a dead process left under the name"},
    {"pid", verb_pid, {"world ", 1}, "[--world NAME] ROLE     pid of a role's live process"},
    {"frame", verb_frame, {"world ", 0}, "[--world NAME]     the last committed frame"},
    {"save",
     verb_save,
     {"world inputs ", 1},
     "[--world NAME] [--inputs] FILE     write an image of the world"},
    {"replay-frame",
     verb_replay_frame,
     {"", 1},
     "DUMP     run the frame after an image's in this process, for a debugger"},
};

#define VERBS (sizeof verbs / sizeof verbs[0])

static int usage(FILE *to, int code)
{
    fprintf(to, "usage: jolon-world VERB ...\n");
    for (size_t i = 0; i < VERBS; i++)
        fprintf(to, "  %-12s %s\n", verbs[i].name, verbs[i].usage);
    fprintf(to, "Every verb takes --help.\n");
    return code;
}

static int run(const struct verb *verb, int argc, char **argv)
{
    struct arguments arguments = arguments_read(argc, argv, &verb->accepted);
    if (!arguments.help)
        return verb->run(&arguments);
    printf("usage: jolon-world %s %s\n", verb->name, verb->usage);
    return EXIT_OK;
}

int main(int argc, char **argv)
{
    log_open("world");
    process_guard();
    if (argc < 2)
        return usage(stderr, EXIT_USAGE);
    if (strcmp(argv[1], "help") == 0 || strcmp(argv[1], "--help") == 0 ||
        strcmp(argv[1], "-h") == 0) {
        if (argc > 2)
            die_usage("%s %s: takes no argument; try jolon-world VERB --help", argv[1], argv[2]);
        return usage(stdout, EXIT_OK);
    }
    for (size_t i = 0; i < VERBS; i++) {
        if (strcmp(argv[1], verbs[i].name) == 0)
            return run(&verbs[i], argc - 1, argv + 1);
    }
    die_usage("%s: no such verb; try jolon-world help", argv[1]);
}
