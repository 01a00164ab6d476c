/* The command line of jolon-intake. */
#ifndef JOLON_REPORTER_INTAKE_OPTIONS_H
#define JOLON_REPORTER_INTAKE_OPTIONS_H

#include <stdbool.h>

struct options {
    const char *world;
    int parent; /* process id, 0: none */
    bool sandbox_off;
};

/* Fills options. Ends the program: with help on standard output (0), or with one line that says
 * what is wrong (2). */
void options_parse(struct options *options, int argc, char **argv);

#endif
