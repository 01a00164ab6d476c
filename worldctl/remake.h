/* Remaking: the world that a log of commands begins with, in this process's own memory. */
#ifndef JOLON_WORLDCTL_REMAKE_H
#define JOLON_WORLDCTL_REMAKE_H

#include "replay/tape.h"

/* From the scenario, or from the image that the world went on from. segment_abandon frees it. Ends
 * the process (exit 1) with what differs from then: the build, the scenario or what it is made of,
 * the image, or any byte of what never changes. */
void remake_world(struct view *view, const struct tape *tape);

/* tape_open(), or ends the process (exit 1) with the reason. A torn end is said. */
void remake_tape(struct tape *tape, const char *path);

#endif
