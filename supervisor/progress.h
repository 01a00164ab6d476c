/* The line of progress that a set in the foreground shows. */
#ifndef JOLON_SUPERVISOR_PROGRESS_H
#define JOLON_SUPERVISOR_PROGRESS_H

#include "ipc/segment/segment.h"

struct progress {
    bool live; /* standard error is a terminal: one line, drawn over */
    uint64_t shown_ns;
};

struct progress progress_begin(void);
/* Shows the line when it is due: four times a second on a terminal, else every 5 s. */
void progress_turn(struct progress *progress, const struct view *view);
/* The line as the run's last word. */
void progress_end(const struct progress *progress, const struct view *view);

#endif
