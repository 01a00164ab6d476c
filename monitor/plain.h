/* The monitor without a screen: one look at the world, or line after line. */
#ifndef JOLON_MONITOR_PLAIN_H
#define JOLON_MONITOR_PLAIN_H

#include "monitor/options.h"
#include "topics/mirror.h"

/* Prints the status once, when all of it has come; waits 3 s for that at most. An exit code. */
int plain_once(struct mirror *mirror, const struct options *options);

/* Prints a line (a JSON object) at the options' rate until the process is asked to stop or nobody
 * reads any more. An exit code. */
int plain_lines(struct mirror *mirror, const struct options *options);

/* Puts a line to standard output; a tail_print. */
bool plain_line(void *unused, const char *line);

/* False when nobody reads standard output any more. */
bool plain_flush(void);

#endif
