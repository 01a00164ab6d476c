/* The monitor without a screen: prints the status once, or line after line. */
#ifndef JOLON_CLIENTS_MONITOR_PLAIN_OUTPUT_H
#define JOLON_CLIENTS_MONITOR_PLAIN_OUTPUT_H

#include "clients/monitor/options.h"
#include "ipc/topics/world_mirror.h"

/* Waits at most 3 s for the whole status and prints it. Returns the exit code. */
int plain_output_once(struct world_mirror *mirror, const struct options *options);

/* Prints a line, or a JSON object, at the options' rate until the process is asked to stop or the
 * reader of standard output has gone. Returns the exit code. */
int plain_output_lines(struct world_mirror *mirror, const struct options *options);

/* An event_merge_print that writes a line to standard output. */
bool plain_output_line(void *unused, const char *line);

/* Flushes standard output. Returns false if its reader has gone. */
bool plain_output_flush(void);

#endif
