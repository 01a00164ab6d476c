/* Finds the verb of a command line. */
#include "ipc/process/program_verbs.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static _Noreturn void refuse(const struct program_verb *verbs, const char *word)
{
    char names[200] = "";
    for (const struct program_verb *verb = verbs; verb->name; verb++) {
        size_t used = strlen(names);
        (void)snprintf(names + used, sizeof names - used, "%s%s", used > 0 ? ", " : "", verb->name);
    }
    die_usage("%s: no such verb; there are %s", word, names);
}

const struct program_verb *program_verbs_find(const struct program_verb *verbs, const char *usage,
                                              int argc, char **argv)
{
    if (argc < 2) {
        fputs(usage, stderr);
        exit(EXIT_USAGE);
    }
    if (strcmp(argv[1], "help") == 0 || strcmp(argv[1], "--help") == 0 ||
        strcmp(argv[1], "-h") == 0) {
        fputs(usage, stdout);
        exit(EXIT_OK);
    }
    for (const struct program_verb *verb = verbs; verb->name; verb++) {
        if (strcmp(argv[1], verb->name) == 0)
            return verb;
    }
    refuse(verbs, argv[1]);
}
