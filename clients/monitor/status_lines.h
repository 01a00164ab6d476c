/* The status as lines of text for the screen, the line mode and --once. Pure. */
#ifndef JOLON_CLIENTS_MONITOR_STATUS_LINES_H
#define JOLON_CLIENTS_MONITOR_STATUS_LINES_H

#include "ipc/topics/world_mirror.h"

#define STATUS_LINES_MAX 256u

/* The whole status in a line: "running  frame 12345  00:03:25.7  60.0 of 60.0 Hz ...". */
void status_lines_status(char line[STATUS_LINES_MAX], const struct world_mirror *mirror,
                         uint64_t now_ns);

/* The status in three lines. */
void status_lines_world(char line[STATUS_LINES_MAX], const struct world_mirror *mirror,
                        uint64_t now_ns);
void status_lines_frame(char line[STATUS_LINES_MAX], const struct world_mirror *mirror);
void status_lines_counts(char line[STATUS_LINES_MAX], const struct world_mirror *mirror);

/* The head and a row of the table of processes. */
void status_lines_process_head(char line[STATUS_LINES_MAX]);
void status_lines_process(char line[STATUS_LINES_MAX], const jolon_ProcessStatus *status);

#endif
