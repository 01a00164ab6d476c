/* The keeper's messages to the user at the start and the end of a run. */
#ifndef JOLON_SUPERVISOR_RUN_REPORT_H
#define JOLON_SUPERVISOR_RUN_REPORT_H

#include "supervisor/process_set.h"

/* Opens the pipe in which the script waits. -1 when path is NULL or cannot be opened. */
int run_report_open_ready(const char *path);

/* Tells the script that the set is up, and closes the pipe. -1: there is no pipe. */
void run_report_ready(int fd);

/* Logs a warning if the reporter takes commands without DDS Security. */
void run_report_warn_unguarded(const struct process_set *set);

/* Logs a warning if the world has settings of a gateway and no gateway. */
void run_report_warn_no_gateway(const struct process_set *set);

/* Prints the summary of the run, to the log if it is in the background. wall_ns: how long it took.
 * Returns an exit code. */
int run_report_summary(const struct process_set *set, uint64_t wall_ns);

#endif
