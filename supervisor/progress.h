/* The progress line of a set in the foreground. */
#ifndef JOLON_SUPERVISOR_PROGRESS_H
#define JOLON_SUPERVISOR_PROGRESS_H

#include "ipc/segment/segment.h"

struct progress {
    bool live; /* standard error is a terminal: the line is drawn over */
    uint64_t shown_ns;
};

struct progress progress_begin(void);
/* Prints the line if it is due: four times a second on a terminal, otherwise every 5 s. */
void progress_update(struct progress *progress, const struct view *view);
/* Prints the final line, on a terminal only. */
void progress_end(const struct progress *progress, const struct view *view);

#endif
