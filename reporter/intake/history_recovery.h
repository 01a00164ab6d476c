/* Recovery of the command history, before a new writer of a command ring takes its first
 * command. */
#ifndef JOLON_REPORTER_INTAKE_HISTORY_RECOVERY_H
#define JOLON_REPORTER_INTAKE_HISTORY_RECOVERY_H

#include "reporter/intake/command_history.h"
#include "ipc/segment/segment.h"

/* Fills the history with the answers in the event ring and the commands that wait in the command
 * ring. Without it a repeated command that the ring has overwritten, or will overwrite next, would
 * be executed again. Reads the whole event ring: some milliseconds. Returns 0, or -1 with errno
 * EBADMSG when the world is damaged. */
int history_recover(struct command_history *history, const struct view *view,
                    enum command_ring ring);

#endif
