/* The keeper's command line, as the script jolon writes it. */
#ifndef JOLON_SUPERVISOR_OPTIONS_H
#define JOLON_SUPERVISOR_OPTIONS_H

#include "supervisor/process_set.h"

/* Reads the options. Wrong usage ends the process (exit 2). */
struct plan options_plan(int argc, char **argv);

#endif
