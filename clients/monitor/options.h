/* The command line of jolon-monitor. */
#ifndef JOLON_CLIENTS_MONITOR_OPTIONS_H
#define JOLON_CLIENTS_MONITOR_OPTIONS_H

#include "ipc/topics/dds_link.h"

#include <stdbool.h>

#define OPTIONS_SCREEN_HZ 5.0
#define OPTIONS_LINES_HZ  1.0

struct options {
    const char *world;
    const char *filter; /* of vehicle_table_matches(); NULL: no vehicles are listed */
    bool once, json, events, lines;
    double rate_hz; /* 0: the default of the mode */
    struct dds_link_options link;
};

/* Fills options. Ends the process at --help (exit 0) and at wrong usage (exit 2). */
void options_parse(struct options *options, int argc, char **argv);

#endif
