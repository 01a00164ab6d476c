/* jolon-world: creates, checks, describes, dumps, watches and removes worlds. The only program that
 * reads configuration. */
#include "ipc/log.h"
#include "worldctl/verbs.h"

#include <stdio.h>
#include <string.h>

struct verb {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *usage;
};

static const struct verb verbs[] = {
    {"create", verb_create,
     "[--world NAME] [--seconds S] [--adopt] [--set KEY=VALUE]... [SCENARIO]     make a world"},
    {"check", verb_check,
     "[--world NAME | [--set KEY=VALUE]... SCENARIO]     check a world's memory, or a scenario"},
    {"info", verb_info, "[--world NAME] [--json]     what the world is made of"},
    {"status", verb_status, "[--world NAME] [--json]     who runs it and how far it is"},
    {"summary", verb_summary, "[--world NAME] [--json] [--wall SECONDS]     what happened"},
    {"digest", verb_digest, "[--world NAME] [--json]     digests of the last committed frame"},
    {"dump", verb_dump,
     "[--world NAME] [--json] [--fixed | --terrain X0,Z0,X1,Z1,STEP]     every entity"},
    {"events", verb_events,
     "[--world NAME] [--follow] [--from FRAME] [--json] [--log FILE]     what happened, in order"},
    {"list", verb_list, "     this user's worlds"},
    {"remove", verb_remove, "[--world NAME] [--force]     free a world's shared memory"},
    {"pid", verb_pid, "[--world NAME] ROLE     pid of a role's live process"},
    {"frame", verb_frame, "[--world NAME]     the last committed frame"},
    {"ready", verb_ready, "[--world NAME] --pid PID ROLE     wait until that process has the role"},
    {"watch", verb_watch,
     "[--world NAME] [--progress] [--hang-ms N]     kill roles that hang, show progress"},
};

#define VERBS (sizeof verbs / sizeof verbs[0])

static int usage(FILE *to, int code)
{
    fprintf(to, "usage: jolon-world VERB ...\n");
    for (size_t i = 0; i < VERBS; i++)
        fprintf(to, "  %-8s %s\n", verbs[i].name, verbs[i].usage);
    return code;
}

int main(int argc, char **argv)
{
    log_open("world");
    if (argc < 2)
        return usage(stderr, EXIT_USAGE);
    if (strcmp(argv[1], "help") == 0 || strcmp(argv[1], "--help") == 0)
        return usage(stdout, EXIT_OK);
    for (size_t i = 0; i < VERBS; i++) {
        if (strcmp(argv[1], verbs[i].name) == 0)
            return verbs[i].run(argc - 1, argv + 1);
    }
    die_usage("%s: no such verb; try jolon-world help", argv[1]);
}
