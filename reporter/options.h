/* The command line of jolon-reporter. */
#ifndef JOLON_REPORTER_OPTIONS_H
#define JOLON_REPORTER_OPTIONS_H

#include "ipc/topics/dds_link.h"

struct options {
    const char *world;
    int parent; /* ends with this process; 0: none */
    bool sandbox_off;
    bool remote_commands; /* commands are taken over DDS too */
    struct dds_link_options link;
};

/* Fills options. --help ends the program with the usage on standard output (exit 0), wrong usage
 * with one line that says what is wrong (exit 2). */
void options_parse(struct options *options, int argc, char **argv);

#endif
