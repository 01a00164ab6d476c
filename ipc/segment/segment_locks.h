/* The holders of a world's roles, by the locks of its lock file. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_LOCKS_H
#define JOLON_IPC_SEGMENT_SEGMENT_LOCKS_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stdint.h>

/* Returns true if a live process holds the role. For a view with an open lock file; opens
 * nothing. */
bool segment_held(const struct view *view, enum role role);

/* Returns the pid in the slot of a held role, 0 when no process holds it. For display only: a
 * process that has just taken the role has not written its pid yet (0, or the previous
 * holder's). */
int segment_holder(const char *name, enum role role);

/* Returns the pid of the live holder of a role. Waits until until_ns (CLOCK_MONOTONIC) for a holder
 * that has not written its pid yet. Returns 0 when no process holds the role, or the time is
 * over. */
int segment_holder_alive(const char *name, enum role role, uint64_t until_ns);

/* Waits until none of the roles 0 .. last is held, at most until until_ns (CLOCK_MONOTONIC).
 * Returns 0, or -1 with the reason: which role is held and, if that is known, by which process. */
int segment_wait_free(const char *name, enum role last, uint64_t until_ns,
                      struct error_text *error);

#endif
