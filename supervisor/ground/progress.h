/* Progress on a terminal: one line that is written again. Main thread only. */
#ifndef JOLON_SUPERVISOR_GROUND_PROGRESS_H
#define JOLON_SUPERVISOR_GROUND_PROGRESS_H

#include <stdint.h>

/* Shows how far a step of the work is, ten times a second at most. Without a terminal it does
 * nothing. */
void progress_show(const char *step, uint32_t done, uint32_t of);

/* Shows how many features of a layer of a map were read, whose number is not known before. 0: the
 * layer begins, which is shown at once. */
void progress_count(const char *map, const char *layer, uint32_t features);

/* Removes the line. */
void progress_end(void);

#endif
