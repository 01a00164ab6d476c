/* Who holds the roles of a world, by the locks of its lock file. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_LOCKS_H
#define JOLON_IPC_SEGMENT_SEGMENT_LOCKS_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stdint.h>

/* Has the role a live holder? For a view that holds a role itself; opens nothing. */
bool segment_held(const struct view *view, enum role role);

/* Pid that the holder of a role has said, 0 when none holds it. For people to read: a holder that
 * has just taken the role has not said it yet (0), or the one before it is still named. */
int segment_holder(const char *name, enum role role);

/* Pid of the live holder of a role. Waits until until_ns (CLOCK_MONOTONIC) for one that has just
 * taken it to say its pid. 0 when nobody holds the role, or has not said it by then. */
int segment_holder_alive(const char *name, enum role role, uint64_t until_ns);

/* Waits until none of the roles 0 .. last is held, by their locks, at most until until_ns
 * (CLOCK_MONOTONIC). 0, or -1 with the reason: which role is held and, if that is known, by whom.
 */
int segment_wait_free(const char *name, enum role last, uint64_t until_ns,
                      struct error_text *error);

#endif
