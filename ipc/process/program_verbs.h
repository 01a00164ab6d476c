/* The verbs of a program that is called as PROGRAM VERB [options]. One thread. */
#ifndef JOLON_IPC_PROCESS_PROGRAM_VERBS_H
#define JOLON_IPC_PROCESS_PROGRAM_VERBS_H

struct program_verb {
    const char *name; /* NULL ends a table */
    int (*run)(int argc, char **argv);
};

/* Returns the verb that the first argument names; it is to be run with argc - 1 and argv + 1. Ends
 * the program after help (status 0, the usage on standard output), without a verb (EXIT_USAGE, the
 * usage on standard error), and with a verb that the table does not have (EXIT_USAGE, a line that
 * names those there are). */
const struct program_verb *program_verbs_find(const struct program_verb *verbs, const char *usage,
                                              int argc, char **argv);

#endif
