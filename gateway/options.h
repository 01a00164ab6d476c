/* The command line of jolon-gateway. */
#ifndef JOLON_GATEWAY_OPTIONS_H
#define JOLON_GATEWAY_OPTIONS_H

#include <stdbool.h>

struct options {
    const char *world;
    int parent; /* ends with this process; 0: none */
    bool sandbox_off;
};

/* Fills options. --help ends the program with the usage on standard output (exit 0), wrong usage
 * with one line that says what is wrong (exit 2). */
void options_parse(struct options *options, int argc, char **argv);

#endif
