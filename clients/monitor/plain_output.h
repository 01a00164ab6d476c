/* The monitor without a screen: one look at the world, or line after line. */
#ifndef JOLON_CLIENTS_MONITOR_PLAIN_OUTPUT_H
#define JOLON_CLIENTS_MONITOR_PLAIN_OUTPUT_H

#include "clients/monitor/options.h"
#include "ipc/topics/world_mirror.h"

/* Prints the status once, when all of it has come; waits 3 s for that at most. An exit code. */
int plain_output_once(struct world_mirror *mirror, const struct options *options);

/* Prints a line (a JSON object) at the options' rate until the process is asked to stop or nobody
 * reads any more. An exit code. */
int plain_output_lines(struct world_mirror *mirror, const struct options *options);

/* Puts a line to standard output; a event_merge_print. */
bool plain_output_line(void *unused, const char *line);

/* False when nobody reads standard output any more. */
bool plain_output_flush(void);

#endif
