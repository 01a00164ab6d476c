/* The command line of jolon-drive. */
#ifndef JOLON_CLIENTS_DRIVE_OPTIONS_H
#define JOLON_CLIENTS_DRIVE_OPTIONS_H

#include "clients/drive/inputs.h"
#include "ipc/topics/dds_link.h"

#include <stdbool.h>

struct options {
    const char *world;
    const char *wanted; /* id, name, kind or force; NULL: any vehicle */
    enum inputs_choice input;
    const char *device; /* of the gamepad, NULL: any */
    bool plain;
    double rate_hz; /* of the screen, or of the lines */
    struct dds_link_options link;
    bool remote; /* commands go over DDS */
};

/* Fills options. Ends the process at --help (exit 0) and at wrong usage (exit 2). */
void options_parse(struct options *options, int argc, char **argv);

#endif
