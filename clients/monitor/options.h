/* The command line of jolon-monitor. */
#ifndef JOLON_CLIENTS_MONITOR_OPTIONS_H
#define JOLON_CLIENTS_MONITOR_OPTIONS_H

#include "ipc/topics/dds_link.h"

#include <stdbool.h>

#define OPTIONS_SCREEN_HZ 5.0
#define OPTIONS_LINES_HZ  1.0

struct options {
    const char *world;
    const char *filter; /* which vehicles, as vehicle_table_matches(); NULL: none are listed */
    bool once, json, events, lines;
    double rate_hz; /* 0: as the mode likes it */
    struct dds_link_options link;
};

/* Fills options. Ends the program: with help on standard output (0), or with one line that says
 * what is wrong (2). */
void options_parse(struct options *options, int argc, char **argv);

#endif
