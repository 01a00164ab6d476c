/* The command line of a role that has no options of its own: the world, the parent, no sandbox. */
#ifndef JOLON_IPC_PROCESS_ROLE_OPTIONS_H
#define JOLON_IPC_PROCESS_ROLE_OPTIONS_H

#include <stdbool.h>

struct role_options {
    const char *world;
    int parent; /* ends with this process; 0: none */
    bool sandbox_off;
};

/* Returns the options of a program. --help ends it with the usage on standard output (exit 0),
 * wrong usage with one line that says what is wrong (exit 2). */
struct role_options role_options_read(const char *program, int argc, char **argv);

#endif
