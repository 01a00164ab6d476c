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
    int plain;         /* plain arguments, at most */
    const char *usage; /* the verb takes the options that it names */
};

static const struct verb verbs[] = {
    {"create", verb_create, 1,
     "[--world NAME] [--seconds S] [--adopt] [--set KEY=VALUE]... [SCENARIO | --from FILE]     "
     "make a world, or continue from an image"},
    {"check", verb_check, 1,
     "[--world NAME | [--set KEY=VALUE]... SCENARIO]     check a world's memory, or a scenario"},
    {"repair", verb_repair, 0,
     "[--world NAME]     set a damaged world that no set runs back to its newest whole frame"},
    {"info", verb_info, 0, "[--world NAME] [--json]     what the world is made of"},
    {"status", verb_status, 0, "[--world NAME] [--json]     its processes and its frame"},
    {"summary", verb_summary, 0,
     "[--world NAME] [--json] [--wall SECONDS]     print what happened in the run"},
    {"digest", verb_digest, 0, "[--world NAME] [--json]     digests of the last committed frame"},
    {"dump", verb_dump, 0,
     "[--world NAME] [--json] [--fixed | --terrain X0,Z0,X1,Z1,STEP]     print every entity"},
    {"events", verb_events, 0,
     "[--world NAME] [--follow] [--from FRAME] [--json]     print the events in order"},
    {"replay", verb_replay, 1,
     "[--frames N] [--json] [--events FILE] [--physics] [--threads N] LOG     replay a log of "
     "commands; --physics: judge every frame"},
    {"diff", verb_diff, 2,
     "[--json] [--threads N] A B     find the first difference of two logs of commands, images, "
     "worlds"},
    {"list", verb_list, 1,
     "[worlds | all | lost]     list this user's worlds; all: also the remains of dead ones; lost: "
     "files in /dev/shm that no name leads to"},
    {"paths", verb_paths, 1,
     "[--world NAME] [name | lock | object | partition]  print the world's paths"},
    {"remove", verb_remove, 0, "[--world NAME] [--force]     free a world's shared memory"},
    {"sweep", verb_sweep, 0, "[--world NAME]     remove what a dead process left under the name"},
    {"pid", verb_pid, 1, "[--world NAME] ROLE     pid of a role's live process"},
    {"frame", verb_frame, 0, "[--world NAME]     the last committed frame"},
    {"save", verb_save, 1, "[--world NAME] [--inputs] FILE     write an image of the world"},
    {"replay-frame", verb_replay_frame, 1,
     "DUMP     compute the frame after an image's in this process, for a debugger"},
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

/* at: index of the verb in argv. Options before it are the verb's, too. */
static int run(const struct verb *verb, int argc, char **argv, int at)
{
    memmove(argv + 2, argv + 1, (size_t)(at - 1) * sizeof *argv);
    struct arguments arguments =
        arguments_read(argc - 1, argv + 1, verb->name, verb->usage, verb->plain);
    return verb->run(&arguments);
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
    int at = arguments_verb(argc, argv);
    const char *name = argv[at < argc ? at : 1];
    for (size_t i = 0; i < VERBS; i++) {
        if (strcmp(name, verbs[i].name) == 0)
            return run(&verbs[i], argc, argv, at);
    }
    die_usage("%s: no such verb; try jolon-world help", name);
}
