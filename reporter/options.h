/* The command line of jolon-reporter. */
#ifndef JOLON_REPORTER_OPTIONS_H
#define JOLON_REPORTER_OPTIONS_H

#include "ipc/topics/dds_link.h"

struct options {
    const char *world;
    int parent; /* process id, 0: none */
    bool sandbox_off;
    bool remote_commands; /* commands are taken over DDS too */
    struct dds_link_options link;
};

/* Fills options. Ends the program: with help on standard output (0), or with one line that says
 * what is wrong (2). */
void options_parse(struct options *options, int argc, char **argv);

#endif
