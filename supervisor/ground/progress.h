/* Progress on a terminal: one line that is written again. Main thread only. */
#ifndef JOLON_SUPERVISOR_GROUND_PROGRESS_H
#define JOLON_SUPERVISOR_GROUND_PROGRESS_H

#include <stdint.h>

/* Shows how far a step of the work is, ten times a second at most. Without a terminal it does
 * nothing. */
void progress_show(const char *step, uint32_t done, uint32_t of);

/* Removes the line. */
void progress_end(void);

#endif
