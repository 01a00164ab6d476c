/* The command line of jolon-harness. */
#ifndef JOLON_CLIENTS_HARNESS_OPTIONS_H
#define JOLON_CLIENTS_HARNESS_OPTIONS_H

#include "ipc/topics/dds_link.h"

struct options {
    const char *world;
    double timeout_s; /* until a command without a reply is given up */
    struct dds_link_options link;
    bool remote; /* commands go over DDS */
};

/* Fills options. Ends the program: with help (0), or with what is wrong in one line (2). */
void options_parse(struct options *options, int argc, char **argv);

#endif
