/* The command line of jolon-harness. */
#ifndef JOLON_CLIENTS_HARNESS_OPTIONS_H
#define JOLON_CLIENTS_HARNESS_OPTIONS_H

#include "ipc/topics/dds_link.h"

struct options {
    const char *world;
    double timeout_s; /* for the world at the start, and for the reply to a command */
    struct dds_link_options link;
    bool remote; /* commands go over DDS */
};

/* Fills options. Ends the process at --help (exit 0) and at wrong usage (exit 2). */
void options_parse(struct options *options, int argc, char **argv);

#endif
