/* What the monitor says in words: lines of text for the screen, the line mode and --once. Pure. */
#ifndef JOLON_MONITOR_LINES_H
#define JOLON_MONITOR_LINES_H

#include "topics/mirror.h"

#define LINES_MAX 256u

/* "running  frame 12345  00:03:25.7  60.0 of 60.0 Hz ...": everything in one line. */
void lines_status(char line[LINES_MAX], const struct mirror *mirror, uint64_t now_ns);

/* The same in three lines. */
void lines_world(char line[LINES_MAX], const struct mirror *mirror, uint64_t now_ns);
void lines_frame(char line[LINES_MAX], const struct mirror *mirror);
void lines_counts(char line[LINES_MAX], const struct mirror *mirror);

/* A table of the processes. */
void lines_process_head(char line[LINES_MAX]);
void lines_process(char line[LINES_MAX], const jolon_ProcessStatus *status);

#endif
